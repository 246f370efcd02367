#include "stages/icp_host.h"

#include <algorithm>
#include <cmath>

#include "stages/icp_points_core.h"
#include "stages/point_lanes.h"

namespace rangepose {

void IcpOptions::check() const {
  RP_CHECK(iterations >= 1, "icp iterations must be at least 1");
  RP_CHECK(last_reach_mm > 0.0 && first_reach_mm >= last_reach_mm,
           "icp reach must be positive and not grow");
  RP_CHECK(search_steps >= 0, "icp search_steps must not be negative");
  RP_CHECK(slide >= 0.0, "icp slide must not be negative");
  RP_CHECK(rim_reach_mm >= 0.0, "icp rim reach must not be negative");
  RP_CHECK(rim_steps >= 1, "icp rim steps must be at least 1");
  RP_CHECK(rim_weight >= 0.0, "icp rim weight must not be negative");
}

double icpShrink(const IcpOptions& options) {
  return std::pow(options.last_reach_mm / options.first_reach_mm,
                  1.0 / std::max(1, options.iterations - 1));
}

namespace host {
namespace {

struct Points {
  std::vector<EightPoints> faces;
  std::vector<EightPoints> rims;
};

Points inEights(const std::vector<SurfacePoint>& points, const IcpOptions& options) {
  Points result;
  result.faces.reserve(points.size() / kLanes + 1);
  for (const SurfacePoint& point : points) {
    if (!isAligned(point, options)) continue;
    append(point.rim ? result.rims : result.faces, point);
  }
  return result;
}

/// The sums of all points, and how many have a partner.
struct PointSums {
  IcpSumsOf<float> sums;
  int pairs;
};

RP_SIMD_CLONES void addAll(const Points& points,
                           const IcpView& view,
                           const DepthPixels& depth,
                           PointSums& result) {
  IcpSumsOf<Float8> sums{};
  Int8 pairs{};
  for (const EightPoints& block : points.faces)
    pairs -= addPoints(sums, view, depth, block.loaded(), false);
  for (const EightPoints& block : points.rims)
    pairs -= addPoints(sums, view, depth, block.loaded(), true);
  result.sums = sumOfLanes(sums);
  result.pairs = 0;
  for (int i = 0; i < kLanes; ++i) result.pairs += pairs[i];
}

}  // namespace

IcpResult icp(const std::vector<SurfacePoint>& points,
              const Camera& camera,
              const Image<float>& scene_mm,
              const Pose& start,
              const glm::dvec3& center_mm,
              double radius_mm,
              const IcpOptions& options) {
  options.check();
  RP_CHECK(camera.width == scene_mm.width() && camera.height == scene_mm.height(),
           "depth image and camera differ in size");
  const DepthPixels depth{scene_mm.data(), scene_mm.width()};
  const Points eights = inEights(points, options);
  IcpResult result{start, 0.0, 0.0, 0};
  const double shrink = icpShrink(options);
  IcpFrame frame = firstFrame(start, center_mm, radius_mm, options);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    PointSums all;
    addAll(eights, icpView(frame, options, camera), depth, all);
    const int count = static_cast<int>(points.size());
    if (!icpAdvance(result, frame, inDoubles(all.sums), all.pairs, count, center_mm, shrink))
      return result;
  }
  return result;
}

}  // namespace host
}  // namespace rangepose
