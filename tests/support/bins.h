// Tables, empty bins and boxes that lie in them, as a tilted camera sees them.
#pragma once

#include <numbers>
#include <vector>

#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose::test {

/// The world's z axis points from the table towards the camera.
inline Pose aboveTable(double distance_mm) {
  constexpr double kTiltRad = 0.2;
  return {rotationFromVector({std::numbers::pi + kTiltRad, 0.0, 0.0}), {0.0, 0.0, distance_mm}};
}

/// On the table.
inline Box boxAt(double x, double y, const glm::dvec3& size) {
  return {{x, y, 0.0}, glm::dvec3(x, y, 0.0) + size};
}

/// A floor with a wall on some sides: -1 or 1 along x.
inline DepthImage emptyBin(const Camera& camera,
                           const Pose& bin,
                           const std::vector<double>& sides) {
  DepthImage image{camera, Image<float>(camera.width, camera.height, 0.0f)};
  measure(image, plateMesh(260.0, 220.0), bin);
  for (const double side : sides) {
    const Pose wall{rotationFromVector({0.0, 0.5 * std::numbers::pi, 0.0}),
                    {130.0 * side, 0.0, 35.0}};
    measure(image, plateMesh(70.0, 220.0), bin * wall);
  }
  return image;
}

}  // namespace rangepose::test
