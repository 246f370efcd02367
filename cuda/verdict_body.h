// The verdict on one pose by one block of threads. Contract in src/stages/check_host.h; see
// block.h.
#pragma once

#include "cuda/block.h"
#include "stages/check_surface_core.h"
#include "stages/surface_points.h"

namespace rangepose::cuda {

/// Points of a posed object. They lie one after the other in an array of all points.
struct PointsTask {
  int first_point = 0;
  int point_count = 0;
  Pose camera_from_object;
  double visible_mm2 = 0.0;  ///< area that the points stand for [mm^2]
  CheckOptions options;
};

/// `points` are those of all tasks; `read` as in posed_points_core.h.
template <typename Block, typename Read>
RP_BODY void judgeTaskPoints(Block& block,
                             const PointsTask& task,
                             const Camera& camera,
                             const Read& read,
                             const SurfacePoint* points,
                             CheckResult& answer) {
  const CheckRules rules = checkRules(task.options, camera, kPointNormalReach);
  const Placement placement = placementOf(task.camera_from_object);
  typename Block::template PerThread<PixelTally<float>> tallies;
  block.forEachThread([&](int thread) {
    PixelTally<float> tally;
    for (int i = thread; i < task.point_count; i += Block::kThreads) {
      const SurfacePoint& point = points[task.first_point + i];
      judgePoints(rules, placement, read, onePoint(point, !point.rim), tally);
    }
    tallies[thread] = tally;
  });
  block.template sum<float>(tallies, [&](const PixelTally<float>& tally) {
    answer = summarizeCheck(tally, task.options, 1.0, task.visible_mm2);
  });
}

/// `surface(x, y)` reads a texel of the rendered surface, inside of its window; `sphere` is that
/// around the object, in the camera frame.
template <typename Block, typename Surface, typename Read>
RP_BODY void judgeRendered(Block& block,
                           const Surface& surface,
                           const SurfaceWindow& window,
                           const Sphere& sphere,
                           const CheckOptions& options,
                           const Camera& camera,
                           const Read& read,
                           CheckResult& answer) {
  const Measured<Read> measured{camera, read};
  const CheckRules rules = checkRules(options, camera, window.step > 2 ? window.step : 2);
  const auto depth_at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < window.width && y < window.height;
    return inside ? surface(x, y).w : 0.0f;
  };
  const RenderedSurface<decltype(depth_at), Read> rendered{
      depth_at, window, measured, sphere, rules};
  typename Block::template PerThread<SurfaceTally> tallies;
  block.forEachThread([&](int thread) {
    SurfaceTally tally;
    for (int i = thread; i < window.width * window.height; i += Block::kThreads) {
      const int x = i % window.width;
      const int y = i / window.width;
      rendered.judge(surface(x, y), x, y, tally);
    }
    tallies[thread] = tally;
  });
  block.template sum<double>(
      tallies, [&](const SurfaceTally& tally) { answer = surfaceVerdict(tally, options); });
}

}  // namespace rangepose::cuda
