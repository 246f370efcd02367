// How firmly seen surface holds a pose: taken for firm, a part that could as well lie an inch aside
// is reported as sure.
#include "geometry/stability.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/pose.h"
#include "geometry/surface_sample.h"
#include "geometry/triangle_corners.h"
#include "solids.h"
#include "support/box_mesh.h"

namespace rangepose {
namespace {

const glm::dmat3 kAsItIs(1.0);

StabilityCovariance covarianceOf(const Mesh& mesh) {
  return stabilityCovariance(mesh, boundingSphere(mesh));
}

/// The faces of a mesh that look along `direction`, with the sphere of all of it.
StabilityCovariance facesAlong(const Mesh& mesh, const glm::dvec3& direction) {
  Mesh some = mesh;
  std::erase_if(some.triangles, [&](const glm::uvec3& triangle) {
    return glm::dot(TriangleCorners(mesh, triangle).cross(), direction) <= 1e-9;
  });
  return stabilityCovariance(some, boundingSphere(mesh));
}

TEST(StabilityTest, TheWholeHoldsItself) {
  const Mesh bracket = test::meshOf(test::bracketBoxes());
  EXPECT_NEAR(stability(covarianceOf(bracket), covarianceOf(bracket), kAsItIs), 1.0, 1e-3);
}

TEST(StabilityTest, APlateSlidesOnItsFaceAndACornerHoldsABox) {
  const Mesh box = test::meshOf({{{-30, -20, -10}, {30, 20, 10}}});
  const StabilityCovariance whole = covarianceOf(box);
  EXPECT_LT(stability(facesAlong(box, {0.0, 0.0, 1.0}), whole, kAsItIs), 0.02);
  EXPECT_LT(stability(facesAlong(box, {0.0, 1.0, 1.0}), whole, kAsItIs), 0.05) << "along an edge";
  EXPECT_GT(stability(facesAlong(box, {1.0, 1.0, 1.0}), whole, kAsItIs), 0.3);
}

TEST(StabilityTest, WhatTheObjectsOwnSymmetryLeavesFreeDoesNotCount) {
  // A rod turns about its axis whatever is seen of it; from the side it also slides along it.
  const Mesh rod = test::prism(64, 10.0, 100.0);
  const StabilityCovariance whole = covarianceOf(rod);
  EXPECT_GT(stability(facesAlong(rod, {0.0, 1.0, 1.0}), whole, kAsItIs), 0.1);
  EXPECT_LT(stability(facesAlong(rod, {0.0, 1.0, 0.0}), whole, kAsItIs), 0.05);
}

TEST(StabilityTest, TheFrameDoesNotMatter) {
  const Mesh box = test::meshOf({{{-30, -20, -10}, {30, 20, 10}}});
  const glm::dmat3 turn = rotationFromVector({0.4, -1.1, 0.7});
  Mesh turned = box;
  for (glm::vec3& vertex : turned.vertices) vertex = glm::vec3(turn * glm::dvec3(vertex));
  const glm::dvec3 along{1.0, 0.6, 1.0};
  const double expected = stability(facesAlong(box, along), covarianceOf(box), kAsItIs);
  EXPECT_NEAR(stability(facesAlong(turned, turn * along), covarianceOf(box), turn), expected, 1e-3);
}

TEST(StabilityTest, TheMeanOverTheAreaIsThatOfManyPoints) {
  const Mesh box = test::meshOf({{{-30, -20, -10}, {30, 20, 10}}});
  const Sphere sphere = boundingSphere(box);
  StabilityCovariance sampled;
  const std::vector<glm::dvec3> points = surfaceSample(box, 40000);
  for (const glm::dvec3& point : points) {
    const glm::dvec3 size = glm::abs(point) / glm::dvec3(30.0, 20.0, 10.0);
    glm::dvec3 normal(0.0);
    for (int i = 0; i < 3; ++i) {
      if (size[i] > 1.0 - 1e-6) normal[i] = point[i] > 0.0 ? 1.0 : -1.0;
    }
    sampled.add(point / sphere.radius_mm, glm::normalize(normal), 1.0 / 40000.0);
  }
  const StabilityCovariance exact = covarianceOf(box);
  for (int i = 0; i < 21; ++i) EXPECT_NEAR(exact.upper[i], sampled.upper[i], 0.01) << i;
}

}  // namespace
}  // namespace rangepose
