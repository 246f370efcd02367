#include "sim/physics_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/mesh_file.h"
#include "sim/convex_hull.h"
#include "sim/depth_oracle.h"
#include "sim/sim_meshes.h"

namespace rangepose {
namespace {

Mesh turned(const Mesh& mesh, const Pose& pose) {
  Mesh result = mesh;
  for (glm::vec3& vertex : result.vertices) vertex = glm::vec3(pose * glm::dvec3(vertex));
  return result;
}

std::vector<double> sorted(const glm::dvec3& v) {
  std::vector<double> values = {v.x, v.y, v.z};
  std::sort(values.begin(), values.end());
  return values;
}

double volumeOf(const std::vector<ConvexPiece>& pieces) {
  double volume = 0.0;
  for (const ConvexPiece& piece : pieces) volume += convexHull(piece.corners_mm).volume;
  return volume;
}

TEST(ConvexHullTest, OfACubeWithPointsInside) {
  std::vector<glm::dvec3> points = {{1, 1, 1}, {0.5, 1.5, 1}};
  for (int k = 0; k < 8; ++k) points.emplace_back(2 * (k & 1), k & 2, (k & 4) / 2);
  const ConvexHull hull = convexHull(points);
  EXPECT_EQ(hull.corners.size(), 8u);
  EXPECT_EQ(hull.triangles.size(), 12u);
  EXPECT_NEAR(hull.volume, 8.0, 1e-9);
  EXPECT_NEAR(hull.outside({3, 1, 1}), 1.0, 1e-9);
  EXPECT_NEAR(hull.outside({1, 1, 1.75}), -0.25, 1e-9);
}

TEST(ConvexHullTest, SimplifiedStaysInsideAndWithinTheTolerance) {
  std::vector<glm::dvec3> points;
  points.reserve(2000);
  Random random(1);
  for (int k = 0; k < 2000; ++k) points.push_back(50.0 * random.rotation()[0]);
  const ConvexHull sphere = convexHull(points);
  const ConvexHull simple = simplifiedHull(sphere, 400, 1.0);
  EXPECT_LT(simple.corners.size(), 200u);
  double out = 0.0;
  for (const glm::dvec3& p : points) out = std::max(out, simple.outside(p));
  EXPECT_LE(out, 1.0 + 1e-6);
  for (const glm::dvec3& p : simple.corners) EXPECT_LE(sphere.outside(p), 0.02);
  EXPECT_EQ(simplifiedHull(sphere, 12, 1e-3).corners.size(), 12u);
}

TEST(SolidMassTest, BoxAnywhereAndHoweverTurned) {
  Random random(2);
  const Pose pose{random.rotation(), {300, -40, 77}};
  const SolidMass mass = solidMass(turned(boxMesh({-30, -20, -5}, {30, 20, 5}), pose));
  EXPECT_NEAR(mass.volume_mm3, 60.0 * 40.0 * 10.0, 0.5);
  EXPECT_LT(glm::distance(mass.center_mm, pose.translation_mm), 1e-3);
  const std::vector<double> inertia = sorted(mass.inertia);
  EXPECT_NEAR(inertia[0], (40.0 * 40.0 + 10.0 * 10.0) / 12.0, 0.05);
  EXPECT_NEAR(inertia[1], (60.0 * 60.0 + 10.0 * 10.0) / 12.0, 0.05);
  EXPECT_NEAR(inertia[2], (60.0 * 60.0 + 40.0 * 40.0) / 12.0, 0.05);
  // The axis of the least inertia is the longest side, however turned.
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (mass.inertia[k] < mass.inertia[least]) least = k;
  }
  const glm::dvec3 axis = mass.object_from_body.rotation[least];
  EXPECT_NEAR(std::abs(glm::dot(axis, pose.rotation[0])), 1.0, 1e-5);
  EXPECT_NEAR(glm::determinant(mass.object_from_body.rotation), 1.0, 1e-9);
}

TEST(SolidMassTest, InsideOutOrFlatIsRefused) {
  Mesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  EXPECT_THROW(solidMass(mesh), Error);
}

TEST(PhysicsPartTest, ASurfaceWithAHoleIsTakenAsItsHull) {
  Mesh mesh = boxMesh({0, 0, 0}, {30, 20, 10});
  mesh.triangles.pop_back();
  const PhysicsPart part = physicsPart(mesh);
  EXPECT_FALSE(part.closed);
  EXPECT_NEAR(part.mass.volume_mm3, 6000.0, 1.0);
  EXPECT_LT(glm::distance(part.mass.center_mm, glm::dvec3(15, 10, 5)), 1e-3);
}

TEST(PhysicsPartTest, AnAngleIsCutIntoItsTwoBars) {
  // One outline of six corners, so that no seam tells where to cut.
  Mesh mesh = boxMesh({0, 0, 0}, {60, 15, 20});
  const Mesh second = boxMesh({0, 15, 0}, {15, 50, 20});
  const auto first = static_cast<unsigned>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const glm::uvec3& t : second.triangles) mesh.triangles.push_back(t + first);
  PieceOptions options;
  options.max_pieces = 2;
  const std::vector<ConvexPiece> pieces = convexPieces(mesh, options);
  ASSERT_EQ(pieces.size(), 2u);
  const double exact = 60.0 * 15.0 * 20.0 + 15.0 * 35.0 * 20.0;
  const double hull = exact + 0.5 * 45.0 * 35.0 * 20.0;
  EXPECT_LT(volumeOf(pieces), exact + 0.15 * (hull - exact));
  EXPECT_GE(volumeOf(pieces), exact - 1.0);
}

TEST(PhysicsPartTest, ConvexStaysWhole) {
  EXPECT_EQ(convexPieces(boxMesh({0, 0, 0}, {30, 20, 10})).size(), 1u);
}

TEST(PhysicsPartTest, PiecesCoverTheSurfaceOfRealParts) {
  Random random(4);
  for (const char* name : {"t_pipe", "bolt", "elbow", "bracket"}) {
    const std::filesystem::path path = std::filesystem::path(RP_MODELS_DIR) / name;
    const Mesh mesh = readMesh(path.string() + ".ply", LengthUnit::kMillimetre);
    const PhysicsPart part = physicsPart(mesh);
    EXPECT_TRUE(part.closed) << name;
    EXPECT_LE(part.pieces.size(), static_cast<std::size_t>(PieceOptions{}.max_pieces)) << name;
    std::vector<ConvexHull> hulls;
    for (const ConvexPiece& piece : part.pieces) {
      hulls.push_back(convexHull(piece.corners_mm));
      EXPECT_LE(piece.short_mm, 0.01 * part.diameter_mm) << name;
    }
    for (const glm::dvec3& point : test::surfaceSamples(mesh, 5000, random)) {
      double out = std::numeric_limits<double>::max();
      for (std::size_t k = 0; k < hulls.size(); ++k) {
        out = std::min(out, hulls[k].outside(point) - part.pieces[k].short_mm);
      }
      ASSERT_LE(out, 1e-4 * part.diameter_mm) << name;
    }
    // Cutting has freed most of what the hull fills and the part does not.
    const double hull_mm3 = convexHull(part.hull_mm).volume;
    EXPECT_LT(volumeOf(part.pieces), 0.75 * hull_mm3) << name;
    EXPECT_GT(part.reach_mm, 0.5 * part.diameter_mm - 1e-3) << name;
  }
}

TEST(PhysicsPartTest, BadOptionsAreRefused) {
  PieceOptions options;
  options.max_pieces = 0;
  EXPECT_THROW(convexPieces(angleMesh(), options), Error);
  options = {};
  options.max_vertices = 3;
  EXPECT_THROW(convexPieces(angleMesh(), options), Error);
  EXPECT_THROW(physicsPart(Mesh{}), Error);
}

}  // namespace
}  // namespace rangepose
