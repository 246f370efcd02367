// Rigid transforms. Names read right to left: `camera_from_object`.
#pragma once

#include <array>

#include "core/glm.h"

namespace rangepose {

/// x_target = rotation * x_source + translation_mm.
struct Pose {
  glm::dmat3 rotation{1.0};        ///< orthonormal, determinant +1
  glm::dvec3 translation_mm{0.0};  ///< [mm]

  glm::dvec3 operator*(const glm::dvec3& point) const { return rotation * point + translation_mm; }
  Pose operator*(const Pose& other) const {
    return {rotation * other.rotation, rotation * other.translation_mm + translation_mm};
  }
  Pose inverse() const {
    const glm::dmat3 transposed = glm::transpose(rotation);
    return {transposed, -(transposed * translation_mm)};
  }
};

/// Angle of the rotation that turns `a` into `b` [rad], 0..pi.
double rotationAngleBetween(const glm::dmat3& a, const glm::dmat3& b);

/// The rotation about the unit axis `vector / |vector|` by |vector| [rad] (Rodrigues).
glm::dmat3 rotationFromVector(const glm::dvec3& vector);

/// The rotation of a unit quaternion w + xi + yj + zk.
glm::dmat3 rotationFromQuaternion(double x, double y, double z, double w);

/// w, x, y, z of the unit quaternion with w >= 0. Divides by the largest component, so it is exact
/// at half turns, too.
std::array<double, 4> quaternionOf(const glm::dmat3& rotation);

/// The nearest rotation to a matrix that has drifted (Gram-Schmidt on its columns).
glm::dmat3 orthonormalized(const glm::dmat3& rotation);

}  // namespace rangepose
