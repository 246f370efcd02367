#include "geometry/orientation_grid.h"

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace rangepose {
namespace {

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

}  // namespace

std::vector<glm::dmat3> uniformRotations(int count) {
  RP_CHECK(count >= 1, "at least one rotation is needed");
  constexpr double kPhi = std::numbers::sqrt2;
  constexpr double kPsi = 1.533751168755204288118041;  // positive root of psi^4 = psi + 4
  std::vector<glm::dmat3> rotations;
  rotations.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double s = i + 0.5;
    const double t = s / count;
    const double turn = 2.0 * std::numbers::pi * s;
    const double alpha = turn / kPhi;
    const double beta = turn / kPsi;
    const double r = std::sqrt(t);
    const double q = std::sqrt(1.0 - t);
    rotations.push_back(rotationFromQuaternion(
        r * std::sin(alpha), r * std::cos(alpha), q * std::sin(beta), q * std::cos(beta)));
  }
  return rotations;
}

}  // namespace rangepose
