// Rotations as quaternions, for print.
#pragma once

#include <array>
#include <cmath>

#include "core/glm.h"

namespace rangepose::cli {

/// w, x, y, z of the unit quaternion with w >= 0. Divides by the largest component, so it is exact
/// at half turns, too.
inline std::array<double, 4> quaternionOf(const glm::dmat3& r) {
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

}  // namespace rangepose::cli
