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

// Inline: called from code for AVX, the compiler leaves the upper halves of registers in use after
// it, which slows down all SSE code to come.
RP_ALWAYS_INLINE PixelTally<float> sumOfLanes(const PixelTally<Float8>& lanes) {
  constexpr int kNumbers = static_cast<int>(sizeof(PixelTally<float>) / sizeof(float));
  Float8 from[kNumbers];
  static_assert(sizeof from == sizeof lanes);
  std::memcpy(from, &lanes, sizeof from);
  float to[kNumbers];
  for (int i = 0; i < kNumbers; ++i) to[i] = sum8(from[i]);
  PixelTally<float> sums;
  std::memcpy(&sums, to, sizeof sums);
  return sums;
}

RP_SIMD_CLONES void judgeAll(const std::vector<SurfacePoint>& points,
                             const CheckRules& rules,
                             const Placement& placement,
                             const DepthPixels& read,
                             PixelTally<float>& result) {
  PixelTally<Float8> tally;
  for (std::size_t next = 0; next < points.size();) {
    EightPoints eight;
    for (int lane = 0; lane < kLanes && next < points.size(); ++next) {
      if (!points[next].rim) eight.set(lane++, points[next]);
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
