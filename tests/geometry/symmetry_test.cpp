// Symmetries of parts whose truth is known by how they are made.
#include "geometry/symmetry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "core/error.h"
#include "geometry/orientation_grid.h"
#include "geometry/solids.h"
#include "geometry/surface_sample.h"
#include "geometry/triangle_tree.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using test::boltMesh;
using test::Box;
using test::meshOf;
using test::moved;
using test::prism;

constexpr double kPi = std::numbers::pi;

Pose anyPose() { return {rotationFromVector({0.9, -1.3, 0.4}), {31.0, -7.0, 12.0}}; }

std::string nameOf(const Mesh& mesh) { return symmetryName(findSymmetries(mesh)); }

/// Largest distance of turned surface points to the surface, by trying every triangle.
double worstDistance(const Mesh& mesh, const Pose& motion) {
  double worst = 0.0;
  std::vector<glm::dvec3> points = surfaceSample(mesh, 60);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 1 + mesh.vertices.size() / 60) {
    points.emplace_back(mesh.vertices[i]);
  }
  for (const glm::dvec3& point : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec3 at = motion * point;
      const glm::dvec3 on =
          nearestOnTriangle(at, mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]);
      nearest = std::min(nearest, glm::distance(at, on));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

void expectClosed(const Symmetries& symmetries) {
  std::vector<Pose> all = {Pose{}};
  all.insert(all.end(), symmetries.discrete.begin(), symmetries.discrete.end());
  for (const Pose& a : all) {
    for (const Pose& b : all) {
      const Pose product = a * b;
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Pose& c) {
        return rotationAngleBetween(product.rotation, c.rotation) < 1e-6 &&
               glm::distance(product.translation_mm, c.translation_mm) < 1e-6;
      }));
    }
  }
}

struct Case {
  std::string label;
  Mesh mesh;
  std::string expected;
};

std::vector<Case> cases() {
  return {{"cube", meshOf({Box{{0, 0, 0}, {20, 20, 20}}}), "O"},
          {"plate", meshOf({Box{{0, 0, 0}, {40, 25, 3}}}), "D2"},
          {"square plate", meshOf({Box{{0, 0, 0}, {30, 30, 3}}}), "D4"},
          {"triangular prism", prism(3, 10.0, 14.0), "D3"},
          {"hexagonal prism", prism(6, 10.0, 14.0), "D6"},
          {"long hexagonal prism", prism(6, 10.0, 60.0), "D6"},
          {"twelve sides, short", prism(12, 10.0, 12.0), "D12"},
          {"twelve sides, thin rod", prism(12, 4.0, 100.0), "revolution, ends alike"},
          {"uneven cylinder", test::unevenCylinder(10.0, 16.0), "revolution, ends alike"},
          {"sphere", test::sphereMesh({3.0, -4.0, 9.0}, 12.0, 24), "sphere"},
          {"tetrahedron", test::tetrahedron(), "T"},
          {"icosahedron", test::icosahedron(), "I"},
          {"unequal L", meshOf(test::bracketBoxes()), "none"},
          {"corner", meshOf({Box{{0, 0, 0}, {30, 9, 10}}, Box{{0, 0, 10}, {9, 14, 28}}}), "none"},
          {"bolt", boltMesh(0.0), "C6"},
          {"bolt with a notch", boltMesh(1.2), "none"},
          {"bolt with a scratch", boltMesh(0.3), "C6"}};
}

TEST(SymmetryTest, IsThatOfTheConstruction) {
  for (const Case& item : cases()) {
    EXPECT_EQ(nameOf(item.mesh), item.expected) << item.label;
  }
}

TEST(SymmetryTest, GroupIsClosedAndEachElementHolds) {
  for (const Case& item : cases()) {
    const Mesh mesh = moved(item.mesh, anyPose());
    const Symmetries symmetries = findSymmetries(mesh);
    EXPECT_EQ(symmetryName(symmetries), item.expected) << item.label << ", moved";
    expectClosed(symmetries);
    const double tolerance_mm = 0.01 * diameter(mesh);
    for (const Pose& pose : symmetries.discrete) {
      EXPECT_LE(worstDistance(mesh, pose), tolerance_mm + 1e-6) << item.label;
    }
    for (const SymmetryAxis& axis : symmetries.continuous) {
      const Symmetries about_it = {{}, {axis}};
      for (const Pose& pose : symmetricPoses(about_it, 1.0, 0.9)) {
        EXPECT_LE(worstDistance(mesh, pose), 1.05 * tolerance_mm) << item.label;
      }
    }
  }
}

TEST(SymmetryTest, ToleranceDecidesWhatACoarseCylinderIs) {
  const Mesh mesh = prism(12, 10.0, 12.0);  // corners stand out by 0.34 mm, diameter 23.3 mm
  EXPECT_EQ(symmetryName(findSymmetries(mesh, {.tolerance = 0.01})), "D12");
  EXPECT_EQ(symmetryName(findSymmetries(mesh, {.tolerance = 0.02})), "revolution, ends alike");
}

TEST(SymmetryTest, AxisOfRevolutionIsExact) {
  const Pose pose = anyPose();
  const Symmetries symmetries = findSymmetries(moved(test::unevenCylinder(10.0, 16.0), pose));
  ASSERT_EQ(symmetries.continuous.size(), 1u);
  const SymmetryAxis& axis = symmetries.continuous[0];
  EXPECT_GT(std::abs(glm::dot(axis.direction, pose.rotation[2])), std::cos(0.3 * kPi / 180.0));
  const glm::dvec3 offset = axis.point_mm - pose.translation_mm;
  EXPECT_LT(glm::length(glm::cross(offset, axis.direction)), 0.1);
}

TEST(SymmetryTest, ConeEndsAreNotAlike) {
  Mesh mesh = prism(64, 10.0, 20.0);
  for (glm::vec3& vertex : mesh.vertices) {
    if (vertex.z > 0.0f) vertex = {0.4f * vertex.x, 0.4f * vertex.y, vertex.z};
  }
  EXPECT_EQ(nameOf(mesh), "revolution");
}

TEST(SymmetryTest, RefusesBadInput) {
  EXPECT_THROW(findSymmetries(Mesh{}), Error);
  EXPECT_THROW(findSymmetries(prism(6, 1.0, 1.0), {.tolerance = 0.0}), Error);
  EXPECT_THROW(symmetricPoses({}, 0.0, 1.0), Error);
}

TEST(SymmetricPosesTest, NeighboursAreCloseEnough) {
  const Symmetries symmetries = findSymmetries(test::unevenCylinder(10.0, 16.0));
  const std::vector<Pose> poses = symmetricPoses(symmetries, 10.0, 2.0);
  EXPECT_EQ(poses[0].rotation, glm::dmat3(1.0));
  EXPECT_EQ(poses.size() % 2, 0u);
  const std::size_t turns = poses.size() / 2;
  EXPECT_EQ(turns, 32u);  // ceil(2 pi 10 / 2)
  const glm::dvec3 rim(10.0, 0.0, 3.0);
  for (std::size_t i = 0; i < turns; ++i) {
    EXPECT_LE(glm::distance(poses[i] * rim, poses[(i + 1) % turns] * rim), 2.0);
  }
}

TEST(SymmetricPosesTest, ListsTheFiniteGroup) {
  EXPECT_EQ(symmetricPoses(findSymmetries(prism(6, 10.0, 14.0)), 10.0, 1.0).size(), 12u);
  EXPECT_EQ(symmetricPoses({}, 10.0, 1.0).size(), 1u);
}

// Axes from files go through any of their points: those of a ball need not name its centre.
TEST(FixedPointTest, IsWhereTheAxesMeetOrTheNearestOfOne) {
  const glm::dvec3 centre(3.0, -4.0, 9.0);
  const glm::dvec3 near(40.0, 2.0, -7.0);
  EXPECT_EQ(fixedPoint({}, near), near);
  std::vector<SymmetryAxis> axes;
  for (const glm::dvec3& along : {glm::dvec3(1, 2, 2), glm::dvec3(2, 1, -2), glm::dvec3(0, 0, 1)}) {
    const glm::dvec3 direction = glm::normalize(along);
    axes.push_back({direction, centre + 70.0 * static_cast<double>(axes.size() + 1) * direction});
    if (axes.size() > 1) {
      EXPECT_LT(glm::distance(fixedPoint(axes, near), centre), 1e-4);
      continue;
    }
    const glm::dvec3 expected = centre + glm::dot(near - centre, direction) * direction;
    EXPECT_LT(glm::distance(fixedPoint(axes, near), expected), 1e-4);
  }
  // So all copies of a ball have its centre where it is.
  for (const Pose& copy : symmetricPoses({{}, axes}, 10.0, 5.0)) {
    EXPECT_LT(glm::distance(copy * centre, centre), 1e-4);
  }
}

TEST(RotationAngleModuloTest, IsTheSmallestOverDenseCopies) {
  const std::vector<glm::dmat3> rotations = uniformRotations(40);
  for (const Case& item : cases()) {
    const std::set<std::string> some = {"cube", "triangular prism", "uneven cylinder", "corner"};
    if (some.count(item.label) == 0) continue;
    const Symmetries symmetries = findSymmetries(moved(item.mesh, anyPose()));
    const std::vector<Pose> copies = symmetricPoses(symmetries, 1.0, 0.004);
    for (std::size_t i = 0; i + 1 < rotations.size(); i += 2) {
      double smallest = kPi;
      for (const Pose& copy : copies) {
        smallest = std::min(smallest,
                            rotationAngleBetween(rotations[i], rotations[i + 1] * copy.rotation));
      }
      EXPECT_NEAR(rotationAngleModulo(symmetries, rotations[i], rotations[i + 1]), smallest, 2.1e-3)
          << item.label;
    }
  }
}

TEST(RotationAngleModuloTest, IsZeroForASphere) {
  const Symmetries symmetries = findSymmetries(test::sphereMesh({3.0, -4.0, 9.0}, 12.0, 24));
  EXPECT_EQ(rotationAngleModulo(symmetries, glm::dmat3(1.0), anyPose().rotation), 0.0);
}

}  // namespace
}  // namespace rangepose
