#include "pipeline/scene_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stages/surface.h"

namespace rangepose {

OrthoCamera sceneCamera(const LateralExtent& all, double pixel_mm, int max_px) {
  OrthoCamera camera;
  if (all.empty()) return camera;
  constexpr int kBorderPx = 2;
  const glm::dvec2 extent = all.high - all.low;
  const double usable = max_px - 2.0 * kBorderPx - 1.0;
  camera.pixel_mm = std::max(pixel_mm, std::max(extent.x, extent.y) / usable);
  camera.width = static_cast<int>(std::ceil(extent.x / camera.pixel_mm)) + 1 + 2 * kBorderPx;
  camera.height = static_cast<int>(std::ceil(extent.y / camera.pixel_mm)) + 1 + 2 * kBorderPx;
  camera.camera_from_ortho.translation_mm = glm::dvec3(0.5 * (all.low + all.high), 0.0);
  return camera;
}

OrthoCamera windowCamera(const Camera& sensor,
                         const glm::dvec3& point_mm,
                         int width_px,
                         double pixel_mm) {
  OrthoCamera camera;
  camera.width = width_px;
  camera.height = width_px;
  camera.pixel_mm = pixel_mm;
  const glm::dvec3 z = sensor.viewingRay(point_mm);
  const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0, 0) - z.x * z);
  camera.camera_from_ortho.rotation = glm::dmat3(x, glm::cross(z, x), z);
  if (sensor.orthographic) {
    camera.camera_from_ortho.translation_mm = glm::dvec3(point_mm.x, point_mm.y, 0.0);
  }
  return camera;
}

PixelBox windowRegion(const Camera& sensor,
                      const glm::dvec3& point_mm,
                      int width_px,
                      double pixel_mm) {
  const PixelBox all{0, 0, sensor.width, sensor.height};
  const OrthoCamera window = windowCamera(sensor, point_mm, width_px, pixel_mm);
  const double half_mm = 0.5 * width_px * pixel_mm;
  glm::dvec2 low(std::numeric_limits<double>::max());
  glm::dvec2 high(std::numeric_limits<double>::lowest());
  for (int corner = 0; corner < 8; ++corner) {
    const auto side_mm = [&](int bit) { return (corner >> bit) % 2 == 0 ? -half_mm : half_mm; };
    const glm::dvec3 seen = point_mm + window.camera_from_ortho.rotation *
                                           glm::dvec3(side_mm(0), side_mm(1), side_mm(2));
    // Too near for a box of that size: read the whole image.
    if (!sensor.orthographic && !(seen.z > 1.0)) return all;
    const glm::dvec2 pixel = sensor.project(seen);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  const PixelBox box{static_cast<int>(std::floor(std::max(low.x, 0.0))),
                     static_cast<int>(std::floor(std::max(low.y, 0.0))),
                     static_cast<int>(std::ceil(std::min(high.x, sensor.width - 1.0))) + 1,
                     static_cast<int>(std::ceil(std::min(high.y, sensor.height - 1.0))) + 1};
  return box.x0 < box.x1 && box.y0 < box.y1 ? box : all;
}

Pose poseOf(const Hypothesis& hypothesis,
            const ReferenceObject& object,
            const OrthoCamera& window) {
  const ReferenceView& view = object.views[static_cast<std::size_t>(hypothesis.view)];
  const glm::dvec3 center_mm = window.pixel_mm * glm::dvec3(hypothesis.translation_px);
  Pose pose;
  pose.rotation = window.camera_from_ortho.rotation * view.rotation;
  pose.translation_mm = window.camera_from_ortho * center_mm - pose.rotation * object.center_mm;
  return pose;
}

}  // namespace rangepose
