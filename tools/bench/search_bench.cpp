// The rough search: every view in every start window.
#include <algorithm>
#include <memory>

#include "bench/fixture.h"
#include "bench/measure.h"

namespace rangepose::bench {
namespace {

/// Reference pixels that the simplexes of one start evaluate in all, counted by running them in
/// lockstep.
double evaluatedPixels(StageSet& host,
                       const ReferenceObject& object,
                       const ObjectTrace& trace,
                       std::size_t window,
                       const SearchOptions& options) {
  const float max_area = object.maxArea();
  std::vector<SimplexState> states;
  for (int i = 0; i < static_cast<int>(object.views.size()); ++i) {
    const glm::vec3 at = startTranslation(object, i, trace.seed_range_px[window]);
    states.push_back(simplexStart(at.x, at.y, at.z, options.simplex.step_px));
  }
  double pixels = 0.0;
  for (bool running = true; running;) {
    std::vector<glm::vec3> candidates;
    candidates.reserve(states.size());
    for (const SimplexState& s : states)
      candidates.emplace_back(s.candidate.x, s.candidate.y, s.candidate.z);
    const std::vector<ErrorTerms> terms =
        host.probe->errorTerms(object, trace.windows[window], candidates, options.error);
    running = false;
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (states[i].phase == static_cast<int>(SimplexPhase::kDone)) continue;
      running = true;
      const float area = object.views[i].area_px;
      pixels += static_cast<double>(area);
      const float factor = areaFactor(options.error.area, area, max_area);
      const float value = errorValue(terms[i], options.error.lambdaPerPx(), factor);
      states[i] =
          simplexStep(states[i], value, options.simplex.spread, options.simplex.max_iterations);
    }
  }
  return pixels;
}

/// 0 iterations: as many as the defaults allow.
void addSearch(Fixture& fixture, const Path& path, int views, int starts, int iterations) {
  std::string name = "BM_RoughSearch/" + path.name + "/views:" + std::to_string(views) +
                     "/starts:" + std::to_string(starts);
  if (iterations > 0) name += "/iterations:" + std::to_string(iterations);
  add(name, [&fixture, path, views, starts, iterations](benchmark::State& state) {
    const ReferenceObject& object = fixture.database(views).objects.front();
    const ObjectTrace& trace = fixture.trace(views).objects.front();
    if (static_cast<int>(trace.windows.size()) < starts) {
      state.SkipWithError("the image has fewer starts");
      return;
    }
    SearchOptions options = trace.search;
    if (iterations > 0) options.simplex.max_iterations = iterations;
    std::vector<std::unique_ptr<ResidentScene>> scenes;
    std::vector<const ResidentScene*> windows;
    std::vector<float> seeds;
    double pixels = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(starts); ++i) {
      scenes.push_back(path.stages->scenes->upload(trace.windows[i]));
      windows.push_back(scenes.back().get());
      seeds.push_back(trace.seed_range_px[i]);
      pixels += evaluatedPixels(*fixture.paths().front().stages, object, trace, i, options);
    }
    for (auto _ : state) {
      benchmark::DoNotOptimize(path.stages->search->search(object, windows, seeds, options));
    }
    rate(state, "evaluated_pixels", pixels);
    rate(state, "simplexes", static_cast<double>(views) * starts);
  });
}

}  // namespace

void registerSearchBenchmarks(Fixture& fixture) {
  for (const Path& path : fixture.paths()) {
    if (path.software) {
      addSearch(fixture, path, 256, 1, 4);
      continue;
    }
    addSearch(fixture, path, 256, 1, 0);
    addSearch(fixture, path, 1024, 1, 0);
    addSearch(fixture, path, 1024, kStarts, 0);
  }
}

}  // namespace rangepose::bench
