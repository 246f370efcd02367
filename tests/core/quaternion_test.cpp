// Rotations as quaternions: what the JSON of an estimate and the files of statistics hold.
#include <gtest/gtest.h>

#include <numbers>

#include "core/pose.h"

namespace rangepose {
namespace {

TEST(QuaternionTest, TurnsByHalfTheAngleAboutTheAxis) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, -2.0, 0.5));
  for (const double angle : {0.0, 1e-6, 0.7, 2.0, 3.0, std::numbers::pi - 1e-9}) {
    const std::array<double, 4> q = quaternionOf(rotationFromVector(axis * angle));
    EXPECT_NEAR(q[0], std::cos(angle / 2), 1e-9) << angle;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(q[static_cast<std::size_t>(i) + 1], axis[i] * std::sin(angle / 2), 1e-9) << angle;
    }
  }
}

TEST(QuaternionTest, HalfTurnsAboutTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::dmat3 turn(-1.0);
    turn[axis][axis] = 1.0;
    const std::array<double, 4> q = quaternionOf(turn);
    EXPECT_EQ(q[0], 0.0);
    EXPECT_EQ(std::abs(q[static_cast<std::size_t>(axis) + 1]), 1.0);
  }
}

}  // namespace
}  // namespace rangepose
