#include "stages/check_host.h"

#include <algorithm>

#include "stages/check_surface_core.h"
#include "stages/point_lanes.h"

namespace rangepose::host {

CheckResult check(const Image<SurfaceTexel>& surface,
                  const SurfaceWindow& window,
                  const DepthImage& depth,
                  const Sphere& sphere,
                  const CheckOptions& options) {
  const DepthPixels read{depth.depth_mm.data(), depth.depth_mm.width()};
  const Measured<DepthPixels> measured{depth.camera, read};
  const auto surface_depth = [&](int x, int y) {
    return surface.contains(x, y) ? surface.at(x, y).w : 0.0f;
  };
  const CheckRules rules = checkRules(options, depth.camera, std::max(2, window.step));
  const RenderedSurface<decltype(surface_depth), DepthPixels> rendered{
      surface_depth, window, measured, sphere, rules};
  SurfaceTally tally;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      rendered.judge(surface.at(x, y), x, y, tally);
    }
  }
  return surfaceVerdict(tally, options);
}

namespace {

RP_SIMD_CLONES void judgeAll(const std::vector<SurfacePoint>& points,
                             const CheckRules& rules,
                             const Placement& placement,
                             const DepthPixels& read,
                             PixelTally<float>& result) {
  PixelTally<Float8> tally;
  for (std::size_t next = 0; next < points.size();) {
    EightPoints eight;
    for (; !eight.full() && next < points.size(); ++next) {
      if (!points[next].rim) eight.add(points[next]);
    }
    judgePoints(rules, placement, read, eight.loaded(), tally);
  }
  result = sumOfLanes(tally);
}

}  // namespace

CheckResult checkPoints(const std::vector<SurfacePoint>& points,
                        const Pose& camera_from_object,
                        double visible_mm2,
                        const DepthImage& depth,
                        const CheckOptions& options) {
  const DepthPixels read{depth.depth_mm.data(), depth.depth_mm.width()};
  const CheckRules rules = checkRules(options, depth.camera, kPointNormalReach);
  PixelTally<float> tally;
  judgeAll(points, rules, placementOf(camera_from_object), read, tally);
  return summarizeCheck(tally, options, 1.0, visible_mm2);
}

}  // namespace rangepose::host
