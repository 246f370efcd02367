#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/orientation_grid.h"
#include "sampling/groups.h"
#include "sampling/view_sampling.h"
#include "sampling/view_symmetry.h"
#include "sim/random.h"

namespace rangepose {
namespace {

using test::anyTurn;
using test::finite;
using test::revolution;

constexpr double kDegree = 0.017453292519943295;

/// Parts that lie on one of two faces, tumbled a little, at any angle about the vertical.
std::vector<glm::dmat3> restingOnTwoFaces(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<glm::dmat3> rotations;
  for (int i = 0; i < count; ++i) {
    const glm::dmat3 face = i % 3 == 0 ? rotationFromVector({1.9, 0.4, 0.0}) : anyTurn();
    const glm::dmat3 spin = rotationFromVector({0.0, 0.0, random.uniform(-3.1416, 3.1416)});
    rotations.push_back(spin * random.smallRotation(0.15) * face);
  }
  return rotations;
}

struct Group {
  std::string name;
  Symmetries symmetries;
  /// What adaptive views must reach for parts that rest on two faces, of uniform ones: the larger
  /// the group, the more of all that looks different is near one of the faces.
  double gain;
};

std::vector<Group> groups() {
  return {{"none", {}, 0.5},
          {"C2", finite(cyclicGroup(2), anyTurn()), 0.6},
          {"C6", finite(cyclicGroup(6), anyTurn()), 0.75},
          {"D4", finite(dihedralGroup(4), anyTurn()), 0.9},
          {"O", finite(octahedralGroup(), anyTurn()), 0.97},
          {"revolution", revolution({1.0, -0.4, 2.0}, false), 0.85},
          {"revolution, ends alike", revolution({1.0, -0.4, 2.0}, true), 0.93}};
}

void expectRotations(const std::vector<glm::dmat3>& views) {
  for (const glm::dmat3& view : views) {
    EXPECT_NEAR(glm::determinant(view), 1.0, 1e-9);
    EXPECT_NEAR(glm::length(view[0]), 1.0, 1e-9);
    EXPECT_NEAR(glm::dot(view[0], view[1]), 0.0, 1e-9);
  }
}

TEST(UniformViewsTest, LeavesNoLargerGapsThanTheGridWithoutSymmetry) {
  std::vector<glm::dmat3> probes = uniformRotations(997);
  for (glm::dmat3& probe : probes) probe = probe * rotationFromVector({0.4, 0.1, 0.9});
  for (const Group& group : groups()) {
    const std::vector<glm::dmat3> views = uniformViews(group.symmetries, 300);
    ASSERT_EQ(views.size(), 300u) << group.name;
    expectRotations(views);
    const Coverage own = coverageOf(group.symmetries, views, probes);
    const Coverage plain = coverageOf(group.symmetries, uniformRotations(300), probes);
    EXPECT_LE(own.mean, 1.02 * plain.mean) << group.name;
    EXPECT_LE(own.percentile_95, 1.02 * plain.percentile_95) << group.name;
  }
}

TEST(UniformViewsTest, WithoutSymmetryItIsTheGridItself) {
  EXPECT_EQ(uniformViews({}, 100), uniformRotations(100));
}

TEST(UniformViewsTest, ASphereNeedsOneView) {
  EXPECT_EQ(uniformViews(test::sphere(), 1024).size(), 1u);
  EXPECT_EQ(adaptiveViews(test::sphere(), uniformRotations(5), {}).size(), 1u);
}

TEST(AdaptiveViewsTest, CoversRestingPartsBetterThanUniform) {
  const std::vector<glm::dmat3> seen = restingOnTwoFaces(1500, 1);
  const std::vector<glm::dmat3> others = restingOnTwoFaces(400, 2);
  AdaptiveOptions options;
  options.views = 300;
  options.even_share = 0.15;
  for (const Group& group : groups()) {
    const std::vector<glm::dmat3> views = adaptiveViews(group.symmetries, seen, options);
    ASSERT_EQ(views.size(), 300u) << group.name;
    expectRotations(views);
    const Coverage adaptive = coverageOf(group.symmetries, views, others);
    const Coverage uniform =
        coverageOf(group.symmetries, uniformViews(group.symmetries, 300), others);
    EXPECT_LT(adaptive.mean, group.gain * uniform.mean) << group.name;
    EXPECT_LT(adaptive.percentile_95, group.gain * uniform.percentile_95) << group.name;
  }
}

TEST(AdaptiveViewsTest, WhatNeverWasSeenIsCoveredToo) {
  AdaptiveOptions options;
  options.views = 500;
  const std::vector<glm::dmat3> views = adaptiveViews({}, restingOnTwoFaces(1500, 1), options);
  const Coverage anywhere = coverageOf({}, views, uniformRotations(600));
  const Coverage uniform = coverageOf({}, uniformRotations(500), uniformRotations(601));
  EXPECT_LT(anywhere.mean, 1.7 * uniform.mean);
  EXPECT_LT(anywhere.largest, 45.0 * kDegree);
}

TEST(AdaptiveViewsTest, EvenDataGiveAboutTheNumbersOfThePaper) {
  AdaptiveOptions options;
  options.even_share = 1.0;
  const std::vector<glm::dmat3> views = adaptiveViews({}, {glm::dmat3(1.0)}, options);
  std::set<std::tuple<long, long, long>> directions;
  for (const glm::dmat3& view : views) {
    const glm::dvec3 d = 1e6 * viewDirection(view);
    directions.insert({std::lround(d.x), std::lround(d.y), std::lround(d.z)});
  }
  EXPECT_GE(directions.size(), 48u);  // the paper: 64 x 16
  EXPECT_LE(directions.size(), 130u);
}

TEST(AdaptiveViewsTest, SameSeedSameViewsWithAnyNumberOfThreads) {
  AdaptiveOptions options;
  options.views = 200;
  const std::vector<glm::dmat3> seen = restingOnTwoFaces(500, 3);
  setThreadCount(1);
  const std::vector<glm::dmat3> one = adaptiveViews({}, seen, options);
  setThreadCount(0);
  EXPECT_EQ(one, adaptiveViews({}, seen, options));
  options.seed = 2;
  EXPECT_NE(one, adaptiveViews({}, seen, options));
}

TEST(AdaptiveViewsTest, FewViewsAndFewObservations) {
  for (const int views : {1, 2, 7}) {
    AdaptiveOptions options;
    options.views = views;
    EXPECT_EQ(adaptiveViews({}, {anyTurn()}, options).size(), static_cast<std::size_t>(views));
    options.even_share = 0.0;
    options.cone_rad = 0.0;
    EXPECT_EQ(adaptiveViews({}, {anyTurn()}, options).size(), static_cast<std::size_t>(views));
  }
}

TEST(AdaptiveViewsTest, RefusesBadOptions) {
  EXPECT_THROW(adaptiveViews({}, {}, {}), Error);
  EXPECT_THROW(adaptiveViews({}, {anyTurn()}, {.views = 0}), Error);
  EXPECT_THROW(adaptiveViews({}, {anyTurn()}, {.even_share = 1.5}), Error);
  EXPECT_THROW(uniformViews({}, 0), Error);
}

TEST(CoverageTest, IsThatOfAHandCountedCase) {
  const auto aboutZ = [](double degrees) {
    return rotationFromVector({0.0, 0.0, degrees * kDegree});
  };
  const Coverage coverage = coverageOf({}, {aboutZ(0), aboutZ(90)}, {aboutZ(10), aboutZ(60)});
  EXPECT_NEAR(coverage.mean, 20.0 * kDegree, 1e-9);
  EXPECT_NEAR(coverage.largest, 30.0 * kDegree, 1e-9);
  const Symmetries quarter = finite(cyclicGroup(4));
  EXPECT_NEAR(coverageOf(quarter, {aboutZ(0)}, {aboutZ(80)}).largest, 10.0 * kDegree, 1e-9);
}

}  // namespace
}  // namespace rangepose
