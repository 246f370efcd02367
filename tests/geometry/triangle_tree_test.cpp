// The tree gives what trying every triangle gives.
#include "geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "geometry/distance_grid.h"
#include "geometry/surface_sample.h"
#include "support/range_scenes.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using test::Random;

Mesh triangleSoup(Random& random, int count) {
  Mesh mesh;
  mesh.name = "soup";
  const auto point = [&random] {
    return glm::vec3(random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-10, 10));
  };
  for (int i = 0; i < count; ++i) {
    const glm::vec3 at = point();
    const unsigned first = static_cast<unsigned>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {at, at + 0.2f * point(), at + 0.3f * point()});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  mesh.triangles.emplace_back(0, 0, 1);  // a segment
  return mesh;
}

/// The nearest of many points of a triangle: never nearer than the truth, and nearly as near.
double sampledDistance(const glm::dvec3& point,
                       const glm::dvec3& a,
                       const glm::dvec3& b,
                       const glm::dvec3& c) {
  constexpr int kSteps = 200;
  double nearest = 1e9;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const glm::dvec3 on = a + (b - a) * (1.0 * i / kSteps) + (c - a) * (1.0 * j / kSteps);
      nearest = std::min(nearest, glm::distance(point, on));
    }
  }
  return nearest;
}

TEST(NearestOnTriangleTest, IsAsNearAsTheNearestOfManyPoints) {
  Random random(5);
  const Mesh mesh = triangleSoup(random, 20);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[t.x];
    const glm::dvec3 b = mesh.vertices[t.y];
    const glm::dvec3 c = mesh.vertices[t.z];
    for (int i = 0; i < 10; ++i) {
      const glm::dvec3 point =
          a + glm::dvec3(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4));
      const double distance = glm::distance(point, nearestOnTriangle(point, a, b, c));
      const double sampled = sampledDistance(point, a, b, c);
      EXPECT_LE(distance, sampled + 1e-9);
      EXPECT_GE(distance, sampled - 0.05);
    }
  }
}

TEST(TriangleTreeTest, NearestIsThatOfAllTriangles) {
  Random random(7);
  for (const int count : {1, 4, 5, 300}) {
    const Mesh mesh = triangleSoup(random, count);
    const TriangleTree tree(mesh);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 point(
          random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20));
      double expected = 1e9;
      for (const glm::uvec3& t : mesh.triangles) {
        expected = std::min(
            expected,
            glm::distance(point,
                          nearestOnTriangle(
                              point, mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z])));
      }
      const NearestPoint nearest = tree.nearest(point);
      EXPECT_NEAR(std::sqrt(nearest.squared_mm2), expected, 1e-9);
      EXPECT_NEAR(glm::distance(point, nearest.point_mm), expected, 1e-9);
      EXPECT_TRUE(tree.touches(point, expected * 1.0001));
      EXPECT_FALSE(tree.touches(point, expected * 0.9999));
    }
  }
}

TEST(TriangleTreeTest, RefusesAMeshWithoutFaces) { EXPECT_THROW(TriangleTree(Mesh{}), Error); }

TEST(DistanceGridTest, FollowsTheDistanceToASphere) {
  const glm::dvec3 centre(3.0, 4.0, 5.0);
  const DistanceGrid grid(TriangleTree(test::sphereMesh(centre, 10.0, 60)), centre, 16.0, 32);
  for (const double radius : {4.0, 7.0, 13.0, 15.0}) {
    const glm::dvec3 outwards = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    const DistanceGrid::Sample sample = grid.at(centre + radius * outwards);
    EXPECT_NEAR(sample.distance_mm, std::abs(radius - 10.0), 0.15);
    const double side = radius > 10.0 ? 1.0 : -1.0;
    EXPECT_GT(glm::dot(sample.gradient, side * outwards), 0.95);
  }
}

TEST(SurfaceSampleTest, SpreadsPointsByArea) {
  Mesh mesh;
  mesh.name = "two squares";
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {6, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  constexpr int kCount = 7000;
  int right = 0;
  int left_half = 0;
  for (const glm::dvec3& point : surfaceSample(mesh, kCount)) {
    right += point.x > 4.0 ? 1 : 0;
    left_half += point.x < 1.5 ? 1 : 0;
  }
  EXPECT_NEAR(right, kCount / 7.0, 20.0);
  EXPECT_NEAR(left_half, kCount * 3.0 / 7.0, 60.0);
}

TEST(AreaMomentsTest, MatchesTheMomentsOfManyPoints) {
  Random random(11);
  const Mesh mesh = triangleSoup(random, 40);
  const AreaMoments moments = areaMoments(mesh);
  const std::vector<glm::dvec3> points = surfaceSample(mesh, 60000);
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& point : points) mean += point / static_cast<double>(points.size());
  EXPECT_LT(glm::distance(mean, moments.centroid_mm), 0.05);
  EXPECT_GT(glm::determinant(moments.axes), 0.999999);
  EXPECT_GE(moments.spread_mm2.x, moments.spread_mm2.y);
  EXPECT_GE(moments.spread_mm2.y, moments.spread_mm2.z);
  for (int axis = 0; axis < 3; ++axis) {
    double variance = 0.0;
    for (const glm::dvec3& point : points) {
      const double along = glm::dot(point - mean, moments.axes[axis]);
      variance += along * along / static_cast<double>(points.size());
    }
    EXPECT_NEAR(variance / moments.spread_mm2[axis], 1.0, 0.02);
  }
}

}  // namespace
}  // namespace rangepose
