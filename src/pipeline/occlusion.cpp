#include "pipeline/occlusion.h"

#include <algorithm>

#include "geometry/triangle_corners.h"

namespace rangepose {

std::vector<float> exitDepths(const Mesh& mesh,
                              const Pose& camera_from_object,
                              const Camera& camera,
                              const SurfaceWindow& window,
                              const std::vector<std::int32_t>& pixels) {
  Mesh away;
  away.vertices = mesh.vertices;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners corners(mesh, triangle);
    const glm::dvec3 normal = camera_from_object.rotation * corners.cross();
    const glm::dvec3 ray = camera.viewingRay(camera_from_object * corners.a);
    if (glm::dot(normal, ray) > 0.0) away.triangles.push_back(triangle);
  }
  const Image<SurfaceTexel> far = host::renderSurface(away, camera, camera_from_object, window);
  std::vector<float> depths;
  depths.reserve(pixels.size());
  for (const std::int32_t at : pixels)
    depths.push_back(far.at(at % camera.width - window.x0, at / camera.width - window.y0).w);
  return depths;
}

void FoundParts::add(const std::vector<std::int32_t>& pixels, const std::vector<float>& exit_mm) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto at = static_cast<std::size_t>(pixels[i]);
    if (part_[at] != kNone) continue;
    part_[at] = count_;
    exit_mm_[at] = exit_mm[i];
  }
  ++count_;
}

double FoundParts::coveredShare(const std::vector<std::int32_t>& explained,
                                const std::vector<BuriedPixel>& buried,
                                double slack_mm) const {
  constexpr double kRival = 0.25;  // of what the pose explains
  if (buried.empty()) return 0.0;
  std::vector<int> shared(static_cast<std::size_t>(count_), 0);
  for (const std::int32_t at : explained) {
    const std::int32_t part = part_[static_cast<std::size_t>(at)];
    if (part != kNone) ++shared[static_cast<std::size_t>(part)];
  }
  const auto covers = [&](const BuriedPixel& pixel) {
    const auto at = static_cast<std::size_t>(pixel.at);
    const std::int32_t part = part_[at];
    if (part == kNone || !(exit_mm_[at] > 0.0f)) return false;
    const int own = shared[static_cast<std::size_t>(part)];
    if (own > kRival * static_cast<double>(explained.size())) return false;
    return static_cast<double>(pixel.depth_mm) > static_cast<double>(exit_mm_[at]) - slack_mm;
  };
  const auto covered = std::count_if(buried.begin(), buried.end(), covers);
  return static_cast<double>(covered) / static_cast<double>(buried.size());
}

CheckResult withCovered(CheckResult check, double share) {
  check.hidden += share * check.buried;
  check.buried -= share * check.buried;
  return check;
}

}  // namespace rangepose
