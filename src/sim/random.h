// Random values that are the same with every standard library: the distributions of <random> are
// not. Only sums, products and square roots are used, so that no mathematics library has a say
// either.
#pragma once

#include <cstdint>
#include <random>

#include "core/glm.h"

namespace rangepose {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Mean 0, deviation 1, as the sum of twelve uniform values: never beyond +-6.
  double normal();
  /// Evenly distributed in the unit disc.
  glm::dvec2 inDisc();
  /// Evenly distributed over all rotations.
  glm::dmat3 rotation();
  /// About an evenly distributed axis; |tan(angle / 2)| is at most `tan_half_angle`.
  glm::dmat3 smallRotation(double tan_half_angle);

 private:
  std::mt19937_64 engine_;
};

}  // namespace rangepose
