#include "stages/icp_host.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "stages/icp_core.h"

namespace rangepose {

void IcpOptions::check() const {
  RP_CHECK(iterations >= 1, "icp iterations must be at least 1");
  RP_CHECK(last_reach_mm > 0.0 && first_reach_mm >= last_reach_mm,
           "icp reach must be positive and not grow");
  RP_CHECK(search_steps >= 0, "icp search_steps must not be negative");
  RP_CHECK(slide >= 0.0, "icp slide must not be negative");
}

namespace host {
namespace {

/// Finds scene points near model points in one depth image.
class Associator {
 public:
  Associator(const Camera& camera, const Image<float>& scene_mm, int steps)
      : camera_(camera), scene_mm_(scene_mm), steps_(steps) {}

  /// The nearest measured point to `point` on a grid of pixels whose spacing follows from
  /// `reach_mm`; nothing if the point is hidden or has no partner within the reach.
  std::optional<glm::dvec3> partner(const glm::dvec3& point, double reach_mm) const {
    if (!camera_.orthographic && point.z <= 1.0) return std::nullopt;
    const glm::dvec2 pixel = camera_.project(point);
    const double u_real = std::floor(pixel.x + 0.5);
    const double v_real = std::floor(pixel.y + 0.5);
    if (!(u_real >= 0.0 && v_real >= 0.0 && u_real < scene_mm_.width() &&
          v_real < scene_mm_.height())) {
      return std::nullopt;
    }
    const int u = static_cast<int>(u_real);
    const int v = static_cast<int>(v_real);
    const double here = scene_mm_.at(u, v);
    if (here != 0.0 && here < point.z - reach_mm) return std::nullopt;
    const double reach_px = reach_mm / camera_.pixelSpacingMm(point.z);
    const int spacing = std::max(1, static_cast<int>(reach_px / steps_));
    double best = reach_mm * reach_mm;
    std::optional<glm::dvec3> nearest;
    for (int dv = -steps_; dv <= steps_; ++dv) {
      for (int du = -steps_; du <= steps_; ++du) {
        const int x = u + du * spacing;
        const int y = v + dv * spacing;
        if (!scene_mm_.contains(x, y)) continue;
        const double depth = scene_mm_.at(x, y);
        if (depth == 0.0) continue;
        const glm::dvec3 candidate = camera_.unproject(x, y, depth);
        const glm::dvec3 gap = candidate - point;
        const double squared = glm::dot(gap, gap);
        if (squared < best) {
          best = squared;
          nearest = candidate;
        }
      }
    }
    return nearest;
  }

 private:
  const Camera& camera_;
  const Image<float>& scene_mm_;
  int steps_;
};

double tukey(double squared_ratio) {
  const double rest = 1.0 - squared_ratio;
  return rest > 0.0 ? rest * rest : 0.0;
}

void assign(double (&target)[3], const glm::dvec3& source) {
  target[0] = source.x;
  target[1] = source.y;
  target[2] = source.z;
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
  const Associator associator(camera, scene_mm, options.search_steps);
  IcpResult result{start, 0.0, 0.0, 0};
  const double shrink = std::pow(options.last_reach_mm / options.first_reach_mm,
                                 1.0 / std::max(1, options.iterations - 1));
  double reach = options.first_reach_mm;
  for (int iteration = 0; iteration < options.iterations; ++iteration, reach *= shrink) {
    Pose& pose = result.camera_from_object;
    const glm::dvec3 center = pose * center_mm;
    IcpSums sums{};
    int pairs = 0;
    for (const SurfacePoint& surface : points) {
      const glm::dvec3 point = pose * glm::dvec3(surface.position_mm);
      const std::optional<glm::dvec3> partner = associator.partner(point, reach);
      if (!partner) continue;
      ++pairs;
      const glm::dvec3 gap = *partner - point;
      double model[3];
      double normal[3];
      double scene[3];
      assign(model, (point - center) / radius_mm);
      assign(normal, pose.rotation * glm::dvec3(surface.normal));
      assign(scene, (*partner - center) / radius_mm);
      addPair(
          sums, model, normal, scene, tukey(glm::dot(gap, gap) / (reach * reach)), options.slide);
    }
    result.iterations = iteration + 1;
    result.paired =
        points.empty() ? 0.0 : static_cast<double>(pairs) / static_cast<double>(points.size());
    if (pairs < 6) return result;
    result.rms_mm = radius_mm * std::sqrt(sums.squared_mm / std::max(sums.weight, 1e-9));
    double step[6];
    if (!solveStep(sums, 1e-4 * sums.weight, step)) return result;
    const glm::dmat3 turn = rotationFromVector({step[0], step[1], step[2]});
    const glm::dvec3 moved = center + radius_mm * glm::dvec3(step[3], step[4], step[5]);
    pose.rotation = orthonormalized(turn * pose.rotation);
    pose.translation_mm = moved - pose.rotation * center_mm;
  }
  return result;
}

}  // namespace host
}  // namespace rangepose
