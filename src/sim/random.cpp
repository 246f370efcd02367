#include "sim/random.h"

#include <cmath>

namespace rangepose {
namespace {

/// Columns of the rotation of the quaternion (w, v), of any length but 0.
glm::dmat3 rotationOf(double w, const glm::dvec3& v) {
  const double length_sq = w * w + glm::dot(v, v);
  const double s = 2.0 / length_sq;
  return {1.0 - s * (v.y * v.y + v.z * v.z),
          s * (v.x * v.y + w * v.z),
          s * (v.x * v.z - w * v.y),
          s * (v.x * v.y - w * v.z),
          1.0 - s * (v.x * v.x + v.z * v.z),
          s * (v.y * v.z + w * v.x),
          s * (v.x * v.z + w * v.y),
          s * (v.y * v.z - w * v.x),
          1.0 - s * (v.x * v.x + v.y * v.y)};
}

}  // namespace

double Random::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform();
  return sum;
}

glm::dvec2 Random::inDisc() {
  while (true) {
    const double x = uniform(-1.0, 1.0);
    const double y = uniform(-1.0, 1.0);
    if (x * x + y * y <= 1.0) return {x, y};
  }
}

glm::dmat3 Random::rotation() {
  while (true) {
    const double w = uniform(-1.0, 1.0);
    const double x = uniform(-1.0, 1.0);
    const double y = uniform(-1.0, 1.0);
    const double z = uniform(-1.0, 1.0);
    const double length_sq = w * w + x * x + y * y + z * z;
    if (length_sq <= 1.0 && length_sq > 1e-6) return rotationOf(w, {x, y, z});
  }
}

glm::dmat3 Random::smallRotation(double tan_half_angle) {
  while (true) {
    const double x = uniform(-1.0, 1.0);
    const double y = uniform(-1.0, 1.0);
    const double z = uniform(-1.0, 1.0);
    const glm::dvec3 v(x, y, z);
    if (glm::dot(v, v) <= 1.0) return rotationOf(1.0, tan_half_angle * v);
  }
}

}  // namespace rangepose
