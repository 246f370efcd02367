// Uniform orientations: a gap in them is an orientation in which parts are not found.
#include "geometry/orientation_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/pose.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Random rotations, evenly spread: unit quaternions by rejection from the cube.
glm::dmat3 randomRotation(test::Random& random) {
  for (;;) {
    const double w = random.uniform(-1, 1);
    const glm::dvec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double length = std::sqrt(w * w + glm::dot(v, v));
    if (length > 1.0 || length < 0.1 || glm::length(v) < 1e-6) continue;
    return rotationFromVector(2.0 * std::acos(w / length) * glm::normalize(v));
  }
}

/// Angle by the trace, unlike rotationAngleBetween.
double traceAngle(const glm::dmat3& a, const glm::dmat3& b) {
  double trace = 0.0;
  for (int i = 0; i < 3; ++i) trace += glm::dot(a[i], b[i]);
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

/// Largest and mean distance of random rotations to the nearest sample [degrees].
std::pair<double, double> measuredRadius(const std::vector<glm::dmat3>& samples, int probes) {
  test::Random random(7);
  double largest = 0.0;
  double sum = 0.0;
  for (int i = 0; i < probes; ++i) {
    const glm::dmat3 probe = randomRotation(random);
    double nearest = 10.0;
    for (const glm::dmat3& sample : samples) nearest = std::min(nearest, traceAngle(probe, sample));
    largest = std::max(largest, nearest * kDegrees);
    sum += nearest * kDegrees;
  }
  return {largest, sum / probes};
}

TEST(OrientationGridTest, AllAreRotations) {
  for (const int count : {1, 2, 37, 1024}) {
    const std::vector<glm::dmat3> rotations = uniformRotations(count);
    ASSERT_EQ(rotations.size(), static_cast<std::size_t>(count));
    for (const glm::dmat3& r : rotations) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(glm::dot(r[i], r[j]), i == j ? 1.0 : 0.0, 1e-12);
        }
      }
      EXPECT_NEAR(glm::determinant(r), 1.0, 1e-12) << "a mirrored view matches no real part";
    }
  }
}

TEST(OrientationGridTest, TheSameCountGivesTheSameRotations) {
  EXPECT_EQ(uniformRotations(512), uniformRotations(512));
}

TEST(OrientationGridTest, NoTwoAreAlike) {
  const std::vector<glm::dmat3> rotations = uniformRotations(1024);
  double nearest = 10.0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      nearest = std::min(nearest, rotationAngleBetween(rotations[i], rotations[j]));
    }
  }
  EXPECT_GT(nearest * kDegrees, 16.0) << "views are wasted on the same orientation";
}

TEST(OrientationGridTest, EveryOrientationHasAViewNearby) {
  const auto [largest, mean] = measuredRadius(uniformRotations(1024), 20000);
  EXPECT_LT(largest, 23.5) << "the header promises about 23 degrees";
  EXPECT_LT(mean, 12.0);
  // A lower bound from the volume of balls in SO(3): tells a broken measurement from a good grid.
  EXPECT_GT(largest, 15.0);
  RecordProperty("largest_deg", std::to_string(largest));
  RecordProperty("mean_deg", std::to_string(mean));
}

TEST(OrientationGridTest, FourTimesTheViewsAreCloserByTheCubeRoot) {
  const double mean_few = measuredRadius(uniformRotations(256), 4000).second;
  const double mean_many = measuredRadius(uniformRotations(1024), 4000).second;
  EXPECT_NEAR(mean_few / mean_many, std::cbrt(4.0), 0.1);
}

TEST(OrientationGridTest, NoRotationsIsAnError) {
  EXPECT_THROW(uniformRotations(0), Error);
  EXPECT_THROW(uniformRotations(-5), Error);
}

}  // namespace
}  // namespace rangepose
