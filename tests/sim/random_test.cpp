#include "sim/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace rangepose {
namespace {

TEST(RandomTest, FirstValuesFollowTheStandardEngine) {
  // mt19937_64 gives 9981545732273789042 as its 10,000th value from the default seed, by the
  // standard.
  Random random(5489);
  double value = 0.0;
  for (int i = 0; i < 10000; ++i) value = random.uniform();
  EXPECT_DOUBLE_EQ(value, std::floor(9981545732273789042.0 / 2048.0) / 9007199254740992.0);
}

TEST(RandomTest, NormalHasMeanZeroAndDeviationOne) {
  Random random(3);
  constexpr int kCount = 20000;
  double sum = 0.0;
  double sum_sq = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    sum_sq += value * value;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.03);
  EXPECT_NEAR(sum_sq / kCount, 1.0, 0.05);
}

TEST(RandomTest, RotationsAreOrthonormalAndSpread) {
  Random random(4);
  std::array<int, 8> octants{};
  for (int i = 0; i < 4000; ++i) {
    const glm::dmat3 rotation = random.rotation();
    ASSERT_NEAR(glm::determinant(rotation), 1.0, 1e-12);
    ASSERT_NEAR(glm::dot(rotation[0], rotation[1]), 0.0, 1e-12);
    const glm::dvec3 z = rotation[2];
    const std::size_t octant = (z.x > 0 ? 1u : 0u) + (z.y > 0 ? 2u : 0u) + (z.z > 0 ? 4u : 0u);
    ++octants.at(octant);
  }
  for (const int count : octants) EXPECT_NEAR(count, 500, 100);
}

TEST(RandomTest, SmallRotationStaysWithinItsAngle) {
  Random random(5);
  double largest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dmat3 rotation = random.smallRotation(0.1);
    const double trace = rotation[0].x + rotation[1].y + rotation[2].z;
    largest = std::max(largest, std::acos(std::min(1.0, 0.5 * (trace - 1.0))));
  }
  EXPECT_LE(largest, 2.0 * std::atan(0.1) + 1e-6);
  EXPECT_GT(largest, 1.6 * std::atan(0.1));
}

}  // namespace
}  // namespace rangepose
