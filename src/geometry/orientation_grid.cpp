#include "geometry/orientation_grid.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/pose.h"

namespace rangepose {

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
