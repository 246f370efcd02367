#include "pipeline/enclosure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/surface_sample.h"

namespace rangepose {

Enclosure::Enclosure(const DepthImage& depth,
                     std::vector<BackgroundPlane> planes,
                     const std::optional<BinBox>& bin,
                     const ReferenceDatabase& database,
                     double noise_mm)
    : depth_(depth),
      planes_(std::move(planes)),
      bin_(bin),
      bin_from_camera_(bin ? bin->camera_from_bin.inverse() : Pose{}) {
  constexpr int kPoints = 200;
  // As far a bin may be from where it is said to be, and a pose from where it will be.
  constexpr double kMargin = 0.05;  // of the diameter
  for (const ReferenceObject& object : database.objects) {
    points_.push_back(surfaceSample(object.mesh, kPoints));
    margins_mm_.push_back(kMargin * object.diameter_mm + 3.0 * noise_mm);
  }
}

double Enclosure::beyondMm(const glm::dvec3& point) const {
  double beyond = std::numeric_limits<double>::lowest();
  for (const BackgroundPlane& plane : planes_) beyond = std::max(beyond, -plane.heightOf(point));
  if (!bin_) return beyond;
  const glm::dvec3 in_bin = bin_from_camera_ * point;
  beyond = std::max(beyond, -in_bin.z);
  if (in_bin.z > bin_->inner_size_mm.z) return beyond;
  return std::max({beyond,
                   std::abs(in_bin.x) - 0.5 * bin_->inner_size_mm.x,
                   std::abs(in_bin.y) - 0.5 * bin_->inner_size_mm.y});
}

double Enclosure::outsideShare(int object, const Pose& camera_from_object) const {
  if (planes_.empty() && !bin_) return 0.0;
  const auto index = static_cast<std::size_t>(object);
  const double margin_mm = margins_mm_[index];
  const Camera& camera = depth_.camera;
  const auto outside = [&](const glm::dvec3& on_object) {
    const glm::dvec3 point = camera_from_object * on_object;
    if (!(beyondMm(point) > margin_mm)) return false;
    const glm::dvec2 pixel = glm::floor(camera.project(point) + 0.5);
    // Not "outside of the image", so that a NaN counts as outside too.
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < camera.width && pixel.y < camera.height)) {
      return false;
    }
    const double seen_mm = depth_.depth_mm.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
    if (!(seen_mm > 0.0 && seen_mm < point.z)) return false;
    return beyondMm(camera.unproject(pixel.x, pixel.y, seen_mm)) < margin_mm;
  };
  const std::vector<glm::dvec3>& points = points_[index];
  const auto count = std::count_if(points.begin(), points.end(), outside);
  return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

}  // namespace rangepose
