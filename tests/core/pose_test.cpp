// Rotations against series and quaternions: a wrong pose here sends the gripper beside every part.
#include "core/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::Random;

/// Double arithmetic on values near 1.
constexpr double kRounding = 1e-12;

double largestDifference(const glm::dmat3& a, const glm::dmat3& b) {
  double largest = 0.0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
    }
  }
  return largest;
}

glm::dvec3 randomVector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

glm::dvec3 randomAxis(Random& random) {
  for (;;) {
    const glm::dvec3 axis = randomVector(random, 1.0);
    if (glm::length(axis) > 0.1 && glm::length(axis) < 1.0) return glm::normalize(axis);
  }
}

Pose randomPose(Random& random) {
  return {rotationFromVector(randomAxis(random) * random.uniform(0.0, 3.0)),
          randomVector(random, 500.0)};
}

/// exp of the cross product matrix by its power series: knows nothing of sines.
glm::dmat3 exponentialSeries(const glm::dvec3& v) {
  glm::dmat3 cross(0.0);
  for (int column = 0; column < 3; ++column) {
    glm::dvec3 unit(0.0);
    unit[column] = 1.0;
    cross[column] = glm::dvec3(
        v.y * unit.z - v.z * unit.y, v.z * unit.x - v.x * unit.z, v.x * unit.y - v.y * unit.x);
  }
  glm::dmat3 term(1.0);
  glm::dmat3 sum(1.0);
  for (int i = 1; i < 60; ++i) {
    term = term * cross * (1.0 / i);
    sum = sum + term;
  }
  return sum;
}

TEST(PoseTest, ProductAppliesTheRightPoseFirst) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose camera_from_bin = randomPose(random);
    const Pose bin_from_object = randomPose(random);
    const glm::dvec3 point = randomVector(random, 100.0);
    const glm::dvec3 at_once = (camera_from_bin * bin_from_object) * point;
    EXPECT_LT(glm::distance(at_once, camera_from_bin * (bin_from_object * point)), 1e-9);
  }
}

TEST(PoseTest, InverseUndoesAPoseFromBothSides) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Pose pose = randomPose(random);
    for (const Pose& none : {pose * pose.inverse(), pose.inverse() * pose}) {
      EXPECT_LT(largestDifference(none.rotation, glm::dmat3(1.0)), kRounding);
      EXPECT_LT(glm::length(none.translation_mm), 1e-9);
    }
  }
}

TEST(PoseTest, RotationFromVectorIsTheMatrixExponential) {
  Random random(3);
  for (const double angle : {0.0, 1e-15, 1e-13, 1e-9, 1e-5, 0.01, 0.7, 2.0, 3.1, 3.14159, 6.0}) {
    for (int i = 0; i < 20; ++i) {
      const glm::dvec3 vector = angle * randomAxis(random);
      EXPECT_LT(largestDifference(rotationFromVector(vector), exponentialSeries(vector)), 1e-11)
          << "angle " << angle;
    }
  }
}

TEST(PoseTest, RotationFromVectorTurnsXToYAboutZ) {
  const glm::dmat3 quarter = rotationFromVector({0.0, 0.0, 0.5 * std::numbers::pi});
  EXPECT_LT(glm::distance(quarter * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)), kRounding);
}

TEST(PoseTest, AngleBetweenFindsTheAngleThatWasTurned) {
  Random random(4);
  // Below 1e-7 acos of a trace gives 0 or noise: a refinement that steps by less would look
  // converged.
  for (const double angle : {0.0, 1e-9, 1e-7, 1e-4, 0.02, 1.0, 3.0}) {
    for (int i = 0; i < 20; ++i) {
      const glm::dmat3 a = randomPose(random).rotation;
      const glm::dmat3 b = rotationFromVector(angle * randomAxis(random)) * a;
      EXPECT_NEAR(rotationAngleBetween(a, b), angle, 1e-13 + 1e-12 * angle);
      EXPECT_DOUBLE_EQ(rotationAngleBetween(a, b), rotationAngleBetween(b, a));
    }
  }
}

TEST(PoseTest, AngleBetweenIsFiniteNearAHalfTurn) {
  Random random(5);
  // There the chord hardly grows with the angle: half of the digits are lost, no more.
  for (const double rest : {0.0, 1e-9, 1e-6, 1e-3}) {
    for (int i = 0; i < 20; ++i) {
      const glm::dmat3 a = randomPose(random).rotation;
      const double angle = std::numbers::pi - rest;
      const glm::dmat3 b = rotationFromVector(angle * randomAxis(random)) * a;
      EXPECT_NEAR(rotationAngleBetween(a, b), angle, 1e-7);
    }
  }
}

TEST(PoseTest, OrthonormalizedRepairsDriftAndKeepsTheRotation) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const glm::dmat3 exact = randomPose(random).rotation;
    glm::dmat3 drifted = exact;
    for (int column = 0; column < 3; ++column) drifted[column] += randomVector(random, 1e-4);
    const glm::dmat3 repaired = orthonormalized(drifted);
    EXPECT_LT(largestDifference(glm::transpose(repaired) * repaired, glm::dmat3(1.0)), kRounding);
    EXPECT_NEAR(glm::determinant(repaired), 1.0, kRounding) << "a mirrored part cannot be gripped";
    EXPECT_LT(rotationAngleBetween(repaired, exact), 5e-4);
    EXPECT_LT(largestDifference(orthonormalized(exact), exact), kRounding);
  }
}

}  // namespace
}  // namespace rangepose
