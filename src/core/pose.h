// Rigid transforms. Names read right to left: `camera_from_object`.
#pragma once

#include <array>
#include <cmath>

#include "core/glm.h"
#include "core/host_device.h"

namespace rangepose {

/// x_target = rotation * x_source + translation_mm.
struct Pose {
  glm::dmat3 rotation{1.0};        ///< orthonormal, determinant +1
  glm::dvec3 translation_mm{0.0};  ///< [mm]

  RP_HD glm::dvec3 operator*(const glm::dvec3& point) const {
    return rotation * point + translation_mm;
  }
  RP_HD Pose operator*(const Pose& other) const {
    return {rotation * other.rotation, rotation * other.translation_mm + translation_mm};
  }
  RP_HD Pose inverse() const {
    const glm::dmat3 transposed = glm::transpose(rotation);
    return {transposed, -(transposed * translation_mm)};
  }
};

/// Angle of the rotation that turns `a` into `b` [rad], 0..pi.
double rotationAngleBetween(const glm::dmat3& a, const glm::dmat3& b);

/// The rotation about the unit axis `vector / |vector|` by |vector| [rad] (Rodrigues).
RP_HD glm::dmat3 rotationFromVector(const glm::dvec3& vector) {
  const double angle = glm::length(vector);
  const glm::dmat3 cross(
      0.0, vector.z, -vector.y, -vector.z, 0.0, vector.x, vector.y, -vector.x, 0.0);
  if (angle < 1e-12) return glm::dmat3(1.0) + cross;
  const double first = std::sin(angle) / angle;
  const double second = (1.0 - std::cos(angle)) / (angle * angle);
  return glm::dmat3(1.0) + first * cross + second * (cross * cross);
}

/// The rotation of a unit quaternion w + xi + yj + zk.
glm::dmat3 rotationFromQuaternion(double x, double y, double z, double w);

/// w, x, y, z of the unit quaternion with w >= 0. Divides by the largest component, so it is exact
/// at half turns, too.
std::array<double, 4> quaternionOf(const glm::dmat3& rotation);

/// The nearest rotation to a matrix that has drifted (Gram-Schmidt on its columns).
RP_HD glm::dmat3 orthonormalized(const glm::dmat3& rotation) {
  const glm::dvec3 x = glm::normalize(rotation[0]);
  const glm::dvec3 y = glm::normalize(rotation[1] - glm::dot(rotation[1], x) * x);
  return {x, y, glm::cross(x, y)};
}

}  // namespace rangepose
