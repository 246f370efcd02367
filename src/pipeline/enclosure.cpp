#include "pipeline/enclosure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/surface_sample.h"

namespace rangepose {
namespace {

constexpr int kPoints = 200;      // on the surface of an object
constexpr int kFewPoints = 50;    // of them
constexpr double kLittle = 0.05;  // share of the surface

}  // namespace

Enclosure::Enclosure(const DepthImage& depth,
                     std::vector<BackgroundPlane> planes,
                     const std::optional<BinBox>& bin,
                     const ReferenceDatabase& database,
                     double noise_mm)
    : depth_(depth),
      planes_(std::move(planes)),
      bin_(bin),
      bin_from_camera_(bin ? bin->camera_from_bin.inverse() : Pose{}) {
  for (const ReferenceObject& object : database.objects) {
    parts_.push_back({object.center_mm,
                      object.radius_mm,
                      kEnclosureMargin * object.diameter_mm + 3.0 * noise_mm,
                      surfaceSample(object.mesh, kPoints)});
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
  const Part& part = parts_[static_cast<std::size_t>(object)];
  return outsideShare(part, camera_from_object, part.margin_mm, kPoints);
}

bool Enclosure::holds(int object, const Pose& camera_from_object, double off_mm) const {
  const Part& part = parts_[static_cast<std::size_t>(object)];
  return outsideShare(part, camera_from_object, part.margin_mm + off_mm, kFewPoints) <= kLittle;
}

double Enclosure::outsideShare(const Part& part,
                               const Pose& camera_from_object,
                               double margin_mm,
                               int points) const {
  const Camera& camera = depth_.camera;
  if (beyondMm(camera_from_object * part.center_mm) + part.radius_mm < margin_mm) return 0.0;
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
  const auto count = std::count_if(part.points.begin(), part.points.begin() + points, outside);
  return static_cast<double>(count) / points;
}

}  // namespace rangepose
