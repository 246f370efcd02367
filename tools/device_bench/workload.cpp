#include "device_bench/workload.h"

#include <algorithm>

#include "geometry/orientation_grid.h"
#include "geometry/symmetry.h"
#include "pipeline/refine.h"
#include "pipeline/scene_window.h"
#include "sim/heap.h"
#include "sim/scanner.h"
#include "stages/reference_host.h"

namespace rangepose::device_bench {
namespace {

DepthImage heapOf(const Mesh& mesh) {
  HeapOptions heap;
  heap.count = 14;
  heap.seed = 7;
  ScannerOptions scanner;
  scanner.width = 640;
  scanner.height = 480;
  scanner.seed = 7;
  const std::vector<Mesh> meshes = {mesh};
  return scanHeap(meshes, makeHeap(meshes, heap), scanner).image;
}

}  // namespace

Workload::Workload(int views, int starts) {
  const Mesh mesh = readModel(std::filesystem::path(RP_MODELS_DIR) / "elbow.ply");
  depth = heapOf(mesh);
  const ChannelOptions channels = channelOptionsFor(kSizePx);
  database.objects.push_back(describeObject(mesh, 1, kSizePx, uniformRotations(views), channels));
  setSymmetries(database.objects.front(), findSymmetries(mesh));
  host::renderReferences(database.objects.front(), channels, {});
  options.starts = starts;
  const std::unique_ptr<StageSet> host = makeHostStages();
  estimate = estimatePoses(depth, std::nullopt, database, options, *host, &trace);
  if (static_cast<int>(first().windows.size()) < starts) {
    throw Error("the heap of the benchmark has fewer starts than " + std::to_string(starts));
  }
  makeTasks();
}

void Workload::makeTasks() {
  constexpr int kPoints = 60;
  constexpr int kRenderPx = 112;
  constexpr int kFinePoints = 900;
  // The best of each window by error, as many as are aligned in a frame.
  std::vector<Hypothesis> kept = first().hypotheses;
  std::stable_sort(kept.begin(), kept.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.error < b.error;
  });
  const auto most = static_cast<std::size_t>(options.effort().kept) *
                    static_cast<std::size_t>(options.effort().starts);
  kept.resize(std::min(kept.size(), most));
  points.reserve(kept.size());
  IcpOptions icp;
  icp.iterations = 8;
  icp.search_steps = 1;
  icp.first_reach_mm = 0.2 * object().diameter_mm;
  icp.last_reach_mm = 2.0 * toleranceFor(object(), estimate.noise_mm);
  for (const Hypothesis& hypothesis : kept) {
    const auto window = static_cast<std::size_t>(hypothesis.window);
    const Pose pose = poseOf(hypothesis, object(), first().windows[window].camera);
    points.push_back(pointsOfView(object(), hypothesis.view, kPoints));
    alignments.push_back({&points.back(), pose, object().center_mm, object().radius_mm, icp});
    verdicts.push_back({&points.back(), pose, 1000.0, {}});
  }
  for (const PoseEstimate& rendered : trace.coarse) {
    RenderTask task;
    task.mesh = &object().mesh;
    task.camera_from_object = rendered.pose;
    task.window = wholeWindowAround(
        depth.camera, rendered.pose * object().center_mm, object().radius_mm, kRenderPx);
    task.max_points = kFinePoints;
    task.center_mm = object().center_mm;
    task.radius_mm = object().radius_mm;
    task.alignment.iterations = 12;
    surfaces.push_back(task);
  }
}

Work imageWork(const Image<float>& image, double bytes_per_pixel, double operations_per_pixel) {
  const auto pixels = static_cast<double>(image.size());
  return {pixels * bytes_per_pixel, pixels * operations_per_pixel};
}

Work searchWork(const Workload& load, StageSet& host) {
  // Of error_core.h, with the sums: two differences with their absolute values and the limit, a
  // weight and a product, three sums, and the conditions around them.
  constexpr double kOperationsPerPixel = 17.0;
  // A view's pixel as it is packed, once for each window.
  constexpr double kBytesPerKeptPixel = 16.0;
  const ReferenceObject& object = load.object();
  const float max_area = object.maxArea();
  Work work;
  for (std::size_t window = 0; window < load.first().windows.size(); ++window) {
    const SearchOptions& options = load.first().search;
    std::vector<SimplexState> states;
    for (int view = 0; view < static_cast<int>(object.views.size()); ++view) {
      const glm::vec3 at = startTranslation(object, view, load.first().seed_range_px[window]);
      states.push_back(simplexStart(at.x, at.y, at.z, options.simplex.step_px));
      work.bytes += kBytesPerKeptPixel *
                    static_cast<double>(object.views[static_cast<std::size_t>(view)].area_px);
    }
    const auto running = [](const SimplexState& s) {
      return s.phase != static_cast<int>(SimplexPhase::kDone);
    };
    while (std::any_of(states.begin(), states.end(), running)) {
      std::vector<glm::vec3> candidates;
      candidates.reserve(states.size());
      for (const SimplexState& s : states)
        candidates.emplace_back(s.candidate.x, s.candidate.y, s.candidate.z);
      const std::vector<ErrorTerms> terms =
          host.probe->errorTerms(object, load.first().windows[window], candidates, options.error);
      for (std::size_t i = 0; i < states.size(); ++i) {
        if (!running(states[i])) continue;
        const float area = object.views[i].area_px;
        work.operations += kOperationsPerPixel * static_cast<double>(area);
        const float factor = areaFactor(options.error.area, area, max_area);
        states[i] = simplexStep(states[i],
                                errorValue(terms[i], options.error.lambdaPerPx(), factor),
                                options.simplex.spread,
                                options.simplex.max_iterations);
      }
    }
  }
  return work;
}

Work alignWork(const Workload& load) {
  // Of icp_core.h, in double: for each scene pixel looked at a ray and a distance; for each pair
  // four rows of a 6x6 system.
  constexpr double kPerLookup = 12.0;
  constexpr double kPerPair = 4.0 * 68.0 + 60.0;
  Work work;
  for (const AlignTask& task : load.alignments) {
    const int side = 2 * task.options.search_steps + 1;
    const auto count = static_cast<double>(task.points->size());
    work.operations += count * task.options.iterations * (side * side * kPerLookup + kPerPair);
    work.bytes += count * (sizeof(SurfacePoint) + task.options.iterations * side * side * 4.0);
  }
  return work;
}

}  // namespace rangepose::device_bench
