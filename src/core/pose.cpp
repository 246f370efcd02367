#include "core/pose.h"

#include <algorithm>
#include <cmath>

namespace rangepose {

double rotationAngleBetween(const glm::dmat3& a, const glm::dmat3& b) {
  // |a - b|_F = 2 sqrt(2) sin(angle / 2): well conditioned where acos of the trace is not.
  double squared = 0.0;
  for (int column = 0; column < 3; ++column) {
    squared += glm::dot(a[column] - b[column], a[column] - b[column]);
  }
  return 2.0 * std::asin(std::min(1.0, std::sqrt(squared / 8.0)));
}

glm::dmat3 rotationFromVector(const glm::dvec3& vector) {
  const double angle = glm::length(vector);
  const glm::dmat3 cross(
      0.0, vector.z, -vector.y, -vector.z, 0.0, vector.x, vector.y, -vector.x, 0.0);
  if (angle < 1e-12) return glm::dmat3(1.0) + cross;
  const double first = std::sin(angle) / angle;
  const double second = (1.0 - std::cos(angle)) / (angle * angle);
  return glm::dmat3(1.0) + first * cross + second * (cross * cross);
}

glm::dmat3 rotationFromQuaternion(double x, double y, double z, double w) {
  // Columns of the usual matrix of a unit quaternion.
  return {1 - 2 * (y * y + z * z),
          2 * (x * y + w * z),
          2 * (x * z - w * y),
          2 * (x * y - w * z),
          1 - 2 * (x * x + z * z),
          2 * (y * z + w * x),
          2 * (x * z + w * y),
          2 * (y * z - w * x),
          1 - 2 * (x * x + y * y)};
}

glm::dmat3 orthonormalized(const glm::dmat3& rotation) {
  const glm::dvec3 x = glm::normalize(rotation[0]);
  const glm::dvec3 y = glm::normalize(rotation[1] - glm::dot(rotation[1], x) * x);
  return {x, y, glm::cross(x, y)};
}

}  // namespace rangepose
