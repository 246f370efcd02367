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

std::array<double, 4> quaternionOf(const glm::dmat3& rotation) {
  const glm::dmat3& r = rotation;
  // Four times the squares of the components, from the diagonal.
  const std::array<double, 4> squares = {1.0 + r[0][0] + r[1][1] + r[2][2],
                                         1.0 + r[0][0] - r[1][1] - r[2][2],
                                         1.0 - r[0][0] + r[1][1] - r[2][2],
                                         1.0 - r[0][0] - r[1][1] + r[2][2]};
  // Four times the products; GLM's first index is the column.
  const double wx = r[1][2] - r[2][1];
  const double wy = r[2][0] - r[0][2];
  const double wz = r[0][1] - r[1][0];
  const double xy = r[0][1] + r[1][0];
  const double xz = r[2][0] + r[0][2];
  const double yz = r[1][2] + r[2][1];
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (squares[i] > squares[largest]) largest = i;
  }
  const std::array<std::array<double, 4>, 4> rows = {{{squares[0], wx, wy, wz},
                                                      {wx, squares[1], xy, xz},
                                                      {wy, xy, squares[2], yz},
                                                      {wz, xz, yz, squares[3]}}};
  std::array<double, 4> q = rows[largest];
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double scale = (q[0] < 0.0 ? -1.0 : 1.0) / length;
  for (double& component : q) component *= scale;
  return q;
}

}  // namespace rangepose
