// Refinement with the points of a view, then with rendered ones, and the check.
#include "bench/fixture.h"
#include "bench/measure.h"
#include "pipeline/refine.h"

namespace rangepose::bench {
namespace {

constexpr int kViews = 1024;

std::vector<Candidate> roughCandidates(Fixture& fixture, const RefineScene& scene) {
  const ObjectTrace& trace = fixture.trace(kViews).objects.front();
  std::vector<OrthoCamera> cameras;
  for (const SceneChannels& window : trace.windows) cameras.push_back(window.camera);
  return bestCandidates(fixture.database(kViews).objects.front(),
                        0,
                        trace.hypotheses,
                        cameras,
                        scene,
                        EstimateOptions().effort().kept);
}

void addCoarse(Fixture& fixture, const Path& path) {
  add("BM_CoarseRefinement/" + path.name, [&fixture, path](benchmark::State& state) {
    const std::unique_ptr<ResidentDepth> resident =
        path.stages->foreground->upload(fixture.demo(), fixture.trace(kViews).foreground);
    const Enclosure enclosure = fixture.enclosure(kViews);
    const RefineScene scene{fixture.demo(), *resident, fixture.noiseMm(), enclosure, *path.stages};
    const std::vector<Candidate> rough = roughCandidates(fixture, scene);
    for (auto _ : state) {
      benchmark::DoNotOptimize(refineCoarsely(
          rough, fixture.database(kViews), scene, EstimateOptions().effort().verified));
    }
    rate(state, "candidates", static_cast<double>(rough.size()));
  });
}

void addFine(Fixture& fixture, const Path& path) {
  add("BM_FineRefinementAndCheck/" + path.name, [&fixture, path](benchmark::State& state) {
    const ReferenceDatabase& database = fixture.database(kViews);
    const std::unique_ptr<ResidentDepth> resident =
        path.stages->foreground->upload(fixture.demo(), fixture.trace(kViews).foreground);
    const Enclosure enclosure = fixture.enclosure(kViews);
    const RefineScene scene{fixture.demo(), *resident, fixture.noiseMm(), enclosure, *path.stages};
    const std::vector<Candidate> coarse = refineCoarsely(
        roughCandidates(fixture, scene), database, scene, EstimateOptions().effort().verified);
    for (auto _ : state) {
      std::vector<Candidate> candidates = coarse;
      refineFinely(candidates, database, scene, EstimateOptions().effort().fine);
      benchmark::DoNotOptimize(candidates);
    }
    rate(state, "candidates", static_cast<double>(coarse.size()));
  });
}

}  // namespace

void registerRefineBenchmarks(Fixture& fixture) {
  for (const Path& path : fixture.paths()) {
    // The glsl path aligns on the host.
    if (path.name != "glsl") addCoarse(fixture, path);
    addFine(fixture, path);
  }
}

}  // namespace rangepose::bench
