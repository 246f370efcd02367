#include "io/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace rangepose {
namespace {

/// Triangles of the polygon, and their summed areas along its normal (0, 0, 1).
double cutArea(const std::vector<glm::dvec3>& vertices, std::vector<glm::uvec3>& triangles) {
  std::vector<unsigned> corners(vertices.size());
  std::iota(corners.begin(), corners.end(), 0u);
  appendTriangles(vertices, corners, triangles);
  double area = 0.0;
  for (const glm::uvec3& t : triangles) {
    const glm::dvec3 twice =
        glm::cross(vertices[t.y] - vertices[t.x], vertices[t.z] - vertices[t.x]);
    EXPECT_GE(twice.z, 0.0) << "wound against the polygon";
    area += twice.z / 2.0;
  }
  return area;
}

TEST(Polygon, ConvexBecomesAFan) {
  std::vector<glm::uvec3> triangles;
  EXPECT_DOUBLE_EQ(cutArea({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, triangles), 4.0);
  EXPECT_EQ(triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, ConcaveKeepsItsArea) {
  std::vector<glm::uvec3> comb_triangles;
  // A comb with two teeth: 5 x 1 and twice 1 x 3.
  const std::vector<glm::dvec3> comb{
      {0, 0, 0}, {5, 0, 0}, {5, 4, 0}, {4, 4, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};
  EXPECT_DOUBLE_EQ(cutArea(comb, comb_triangles), 11.0);
  EXPECT_EQ(comb_triangles.size(), comb.size() - 2);

  std::vector<glm::uvec3> star_triangles;
  std::vector<glm::dvec3> star;
  for (int i = 0; i < 14; ++i) {
    const double angle = M_PI * i / 7.0;
    const double radius = i % 2 == 0 ? 3.0 : 1.0;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 1.0);
  }
  EXPECT_NEAR(cutArea(star, star_triangles), 14 * 0.5 * 3.0 * std::sin(M_PI / 7.0), 1e-12);
}

TEST(Polygon, CrossingOutlineStillEnds) {
  std::vector<glm::uvec3> triangles;
  appendTriangles({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 3}, triangles);
  EXPECT_EQ(triangles.size(), 2u);
  triangles.clear();
  appendTriangles({{0, 0, 0}, {1, 1, 0}}, {0, 1}, triangles);
  EXPECT_TRUE(triangles.empty());
}

}  // namespace
}  // namespace rangepose
