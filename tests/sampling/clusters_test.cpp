#include "sampling/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/orientation_grid.h"
#include "sampling/groups.h"
#include "sampling/view_symmetry.h"
#include "sim/random.h"

namespace rangepose {
namespace {

constexpr double kPi = std::numbers::pi;
const std::vector<glm::dmat3> kNoGroup = {glm::dmat3(1.0)};

/// Points within about `radius` of a centre.
void addBlob(std::vector<WeightedDirection>& points,
             Random& random,
             const glm::dvec3& centre,
             double radius,
             int count) {
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 at = radius * random.inDisc();
    const glm::dmat3 turn = shortestTurn({0.0, 0.0, 1.0}, glm::normalize(centre));
    points.push_back({glm::normalize(turn * glm::dvec3(at.x, at.y, 1.0)), 1.0});
  }
}

double nearestCentre(const std::vector<glm::dvec3>& centres, const glm::dvec3& direction) {
  double nearest = 10.0;
  for (const glm::dvec3& centre : centres) {
    nearest = std::min(nearest, glm::distance(centre, glm::normalize(direction)));
  }
  return nearest;
}

TEST(ClusterDirectionsTest, FindsSeparateHeaps) {
  Random random(3);
  std::vector<WeightedDirection> points;
  const std::vector<glm::dvec3> heaps = {{1, 0, 0}, {0, 1, 0.2}, {-1, -1, 1}, {0.1, 0.2, -1}};
  for (const glm::dvec3& heap : heaps) addBlob(points, random, heap, 0.15, 100);
  const DirectionClusters clusters = clusterDirections(points, kNoGroup, 4, 1);
  ASSERT_EQ(clusters.centres.size(), 4u);
  for (const glm::dvec3& heap : heaps) EXPECT_LT(nearestCentre(clusters.centres, heap), 0.04);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(clusters.assignments[i].cluster, clusters.assignments[i - i % 100].cluster);
  }
}

TEST(ClusterDirectionsTest, CopiesAreOneHeap) {
  Random random(4);
  const std::vector<glm::dmat3> group = dihedralGroup(3);
  std::vector<WeightedDirection> points;
  const glm::dvec3 first = glm::normalize(glm::dvec3(1.0, 0.3, 0.4));
  const glm::dvec3 second = glm::normalize(glm::dvec3(0.5, -0.1, 0.9));
  for (const glm::dmat3& element : group) {
    addBlob(points, random, element * first, 0.1, 50);
    addBlob(points, random, element * second, 0.1, 50);
  }
  const DirectionClusters clusters = clusterDirections(points, group, 2, 1);
  ASSERT_EQ(clusters.centres.size(), 2u);
  for (const glm::dvec3& heap : {first, second}) {
    double nearest = 10.0;
    for (const glm::dmat3& element : group) {
      nearest = std::min(nearest, nearestCentre(clusters.centres, element * heap));
    }
    EXPECT_LT(nearest, 0.03);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Assignment& own = clusters.assignments[i];
    EXPECT_LT(own.squared, 0.02);
    const glm::dvec3 image = group[static_cast<std::size_t>(own.element)] * points[i].direction;
    const glm::dvec3& centre = clusters.centres[static_cast<std::size_t>(own.cluster)];
    EXPECT_NEAR(glm::dot(image - centre, image - centre), own.squared, 1e-9);
  }
}

TEST(ClusterDirectionsTest, EachPointIsWithItsNearestCentre) {
  std::vector<WeightedDirection> points;
  for (const glm::dmat3& rotation : uniformRotations(500)) points.push_back({rotation[0], 1.0});
  const std::vector<glm::dmat3> group = cyclicGroup(4);
  const DirectionClusters clusters = clusterDirections(points, group, 20, 9);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double nearest = 10.0;
    for (const glm::dmat3& element : group) {
      nearest = std::min(nearest, nearestCentre(clusters.centres, element * points[i].direction));
    }
    EXPECT_NEAR(std::sqrt(clusters.assignments[i].squared), nearest, 1e-7);
  }
}

TEST(ClusterDirectionsTest, WeightsPullTheCentre) {
  const glm::dvec3 a(1.0, 0.0, 0.0);
  const glm::dvec3 b = glm::normalize(glm::dvec3(1.0, 0.5, 0.0));
  const auto centre = [&](double weight) {
    return clusterDirections({{a, 1.0}, {b, weight}}, kNoGroup, 1, 1).centres[0];
  };
  EXPECT_NEAR(glm::distance(centre(1.0), a), glm::distance(centre(1.0), b), 1e-9);
  EXPECT_LT(glm::distance(centre(9.0), b), 0.2 * glm::distance(centre(9.0), a));
}

TEST(ClusterDirectionsTest, FewerPointsThanCentres) {
  const std::vector<WeightedDirection> points = {{{1, 0, 0}, 1.0}, {{0, 1, 0}, 1.0}};
  EXPECT_EQ(clusterDirections(points, kNoGroup, 5, 1).centres.size(), 2u);
  EXPECT_EQ(clusterDirections(points, cyclicGroup(4), 5, 1).centres.size(), 1u);
  EXPECT_THROW(clusterDirections({}, kNoGroup, 1, 1), Error);
}

TEST(ClusterDirectionsTest, DoesNotDependOnThreads) {
  std::vector<WeightedDirection> points;
  for (const glm::dmat3& rotation : uniformRotations(3000)) points.push_back({rotation[0], 1.0});
  setThreadCount(1);
  const DirectionClusters one = clusterDirections(points, cyclicGroup(2), 30, 5);
  setThreadCount(0);
  const DirectionClusters all = clusterDirections(points, cyclicGroup(2), 30, 5);
  EXPECT_EQ(one.centres, all.centres);
}

TEST(ClusterAnglesTest, FindsHeapsAlsoAcrossTheSeam) {
  std::vector<WeightedAngle> points;
  for (int i = -10; i <= 10; ++i) {
    points.push_back({0.01 * i, 1.0});  // about 0: half of it near the period
    points.push_back({2.0 + 0.01 * i, 1.0});
    points.push_back({4.0 + 0.01 * i, 1.0});
  }
  const std::vector<double> centres = clusterAngles(points, 2.0 * kPi, 3);
  ASSERT_EQ(centres.size(), 3u);
  for (const double expected : {0.0, 2.0, 4.0}) {
    EXPECT_TRUE(std::any_of(centres.begin(), centres.end(), [&](double centre) {
      const double off = std::abs(centre - expected);
      return std::min(off, 2.0 * kPi - off) < 1e-3;
    })) << expected;
  }
}

TEST(ClusterAnglesTest, SpreadsEvenDataEvenly) {
  constexpr double kPeriod = kPi / 3.0;
  std::vector<WeightedAngle> points;
  points.reserve(1000);
  for (int i = 0; i < 1000; ++i) points.push_back({7.0 * kPeriod * i / 1000.0 + 0.3, 1.0});
  const std::vector<double> centres = clusterAngles(points, kPeriod, 8);
  for (std::size_t i = 0; i < 8; ++i) {
    const double gap = i < 7 ? centres[i + 1] - centres[i] : centres[0] + kPeriod - centres[7];
    EXPECT_NEAR(gap, kPeriod / 8.0, 0.1 * kPeriod / 8.0);
    EXPECT_GE(centres[i], 0.0);
    EXPECT_LT(centres[i], kPeriod);
  }
}

TEST(ClusterAnglesTest, IsEvenWithoutData) {
  const std::vector<double> centres = clusterAngles({}, 2.0, 4);
  EXPECT_EQ(centres, (std::vector<double>{0.25, 0.75, 1.25, 1.75}));
  EXPECT_THROW(clusterAngles({}, 0.0, 4), Error);
}

}  // namespace
}  // namespace rangepose
