#include "stages/icp_host.h"

#include <algorithm>
#include <cmath>

namespace rangepose {

void IcpOptions::check() const {
  RP_CHECK(iterations >= 1, "icp iterations must be at least 1");
  RP_CHECK(last_reach_mm > 0.0 && first_reach_mm >= last_reach_mm,
           "icp reach must be positive and not grow");
  RP_CHECK(search_steps >= 0, "icp search_steps must not be negative");
  RP_CHECK(slide >= 0.0, "icp slide must not be negative");
  RP_CHECK(rim_reach_mm >= 0.0, "icp rim reach must not be negative");
  RP_CHECK(rim_weight >= 0.0, "icp rim weight must not be negative");
}

double icpShrink(const IcpOptions& options) {
  return std::pow(options.last_reach_mm / options.first_reach_mm,
                  1.0 / std::max(1, options.iterations - 1));
}

namespace host {

IcpResult icp(const std::vector<SurfacePoint>& points,
              const Camera& camera,
              const Image<float>& scene_mm,
              const Pose& start,
              const glm::dvec3& center_mm,
              double radius_mm,
              const IcpOptions& options) {
  options.check();
  const auto read = [&](int u, int v) { return scene_mm.at(u, v); };
  const DepthReader<decltype(read)> scene{camera, scene_mm.width(), scene_mm.height(), read};
  IcpResult result{start, 0.0, 0.0, 0};
  const double shrink = icpShrink(options);
  IcpFrame frame = firstFrame(start, center_mm, radius_mm, options);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    IcpSums sums{};
    int pairs = 0;
    for (const SurfacePoint& point : points) {
      if (addPoint(sums, frame, scene, point)) ++pairs;
    }
    result.iterations = iteration + 1;
    result.paired =
        points.empty() ? 0.0 : static_cast<double>(pairs) / static_cast<double>(points.size());
    if (pairs < kFewestPairs) return result;
    result.rms_mm = icpRms(sums, radius_mm);
    if (!icpMove(result.camera_from_object, sums, frame, center_mm)) return result;
    frame.pose = result.camera_from_object;
    frame.center_mm = frame.pose * center_mm;
    frame.reach_mm *= shrink;
  }
  return result;
}

}  // namespace host
}  // namespace rangepose
