#include "stages/check_host.h"

#include <algorithm>

#include "stages/check_surface_core.h"

namespace rangepose::host {

CheckResult check(const Image<SurfaceTexel>& surface,
                  const SurfaceWindow& window,
                  const DepthImage& depth,
                  const Sphere& sphere,
                  const CheckOptions& options) {
  const auto read = [&](int u, int v) { return depth.depth_mm.at(u, v); };
  const Measured<decltype(read)> measured{depth.camera, options.tolerance_mm, read};
  const auto surface_depth = [&](int x, int y) {
    return surface.contains(x, y) ? surface.at(x, y).w : 0.0f;
  };
  const CheckRules rules = checkRules(options, std::max(2, window.step));
  const RenderedSurface<decltype(surface_depth), decltype(read)> rendered{
      surface_depth, window, measured, sphere, rules};
  SurfaceTally tally;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      rendered.judge(surface.at(x, y), x, y, tally);
    }
  }
  return surfaceVerdict(tally, options);
}

CheckResult checkPoints(const std::vector<SurfacePoint>& points,
                        const Pose& camera_from_object,
                        double visible_mm2,
                        const DepthImage& depth,
                        const CheckOptions& options) {
  const auto read = [&](int u, int v) { return depth.depth_mm.at(u, v); };
  const Measured<decltype(read)> measured{depth.camera, options.tolerance_mm, read};
  const CheckRules rules = checkRules(options, kPointNormalReach);
  CheckTally tally;
  for (const SurfacePoint& point : points) {
    judgePoint(point, camera_from_object, measured, rules, tally);
  }
  return summarizeCheck(tally, options, 1.0, visible_mm2);
}

}  // namespace rangepose::host
