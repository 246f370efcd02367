// Meshes: what is refused, and the sizes that the pixel size and every error threshold follow from.
#include "geometry/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "geometry/surface_sample.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::Random;
using testing::AllOf;
using testing::HasSubstr;

Mesh triangle() {
  Mesh mesh;
  mesh.name = "plate";
  mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

std::string messageFor(const Mesh& mesh) {
  try {
    checkMesh(mesh);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

Mesh randomCloud(Random& random, int points) {
  Mesh mesh;
  const double flat = random.uniform(0.0, 1.0);
  const double shift = random.uniform(-1000.0, 1000.0);
  for (int i = 0; i < points; ++i) {
    mesh.vertices.emplace_back(
        random.uniform(-50, 50) + shift, random.uniform(-50, 50), random.uniform(-50, 50) * flat);
  }
  return mesh;
}

TEST(MeshTest, ASoundMeshIsAccepted) {
  EXPECT_NO_THROW(checkMesh(triangle()));
  EXPECT_NO_THROW(checkMesh(test::meshOf(test::bracketBoxes())));
}

TEST(MeshTest, FaultsAreNamedWithMeshAndElement) {
  Mesh cloud = triangle();
  cloud.triangles.clear();
  EXPECT_THAT(messageFor(cloud), AllOf(HasSubstr("plate"), HasSubstr("no faces")));
  EXPECT_THAT(messageFor(Mesh{}), HasSubstr("no faces"));

  Mesh bad_index = triangle();
  bad_index.triangles.emplace_back(0, 1, 3);
  EXPECT_THAT(messageFor(bad_index), AllOf(HasSubstr("plate"), HasSubstr("face 1")));

  for (const float value : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      Mesh not_finite = triangle();
      not_finite.vertices[2][axis] = value;
      EXPECT_THAT(messageFor(not_finite), AllOf(HasSubstr("plate"), HasSubstr("vertex 2")));
    }
  }

  Mesh needle = triangle();
  needle.vertices[2] = {5, 0, 0};
  EXPECT_THAT(messageFor(needle), AllOf(HasSubstr("plate"), HasSubstr("area")));
  needle.triangles.emplace_back(1, 1, 2);
  EXPECT_THAT(messageFor(needle), HasSubstr("area"));
}

TEST(MeshTest, OneFaceWithAnAreaIsEnough) {
  Mesh mesh = triangle();
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});
  EXPECT_EQ(messageFor(mesh), "accepted");
}

TEST(MeshTest, CleanedKeepsTheSurfaceAndDropsTheRest) {
  Mesh mesh;
  mesh.name = "plate";
  mesh.vertices = {{9, 9, 9}, {0, 0, 0}, {10, 0, 0}, {5, 0, 0}, {0, 10, 0}, {0, 0, 7}};
  mesh.triangles = {{1, 2, 3}, {1, 2, 4}, {4, 4, 1}, {2, 4, 5}};
  const Mesh result = cleaned(mesh);
  EXPECT_EQ(result.name, "plate");
  ASSERT_EQ(result.triangles.size(), 2U);
  EXPECT_EQ(result.vertices.size(), 4U) << "an unused vertex would enlarge the bounding sphere";
  const glm::uvec3 kept[2] = {{1, 2, 4}, {2, 4, 5}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(result.vertices[result.triangles[i][corner]], mesh.vertices[kept[i][corner]]);
    }
  }
}

TEST(MeshTest, DiameterIsThatOfAllPairs) {
  Random random(1);
  for (int cloud = 0; cloud < 60; ++cloud) {
    const Mesh mesh = randomCloud(random, 2 + random.index(150));
    double expected = 0.0;
    for (const glm::vec3& a : mesh.vertices) {
      for (const glm::vec3& b : mesh.vertices) {
        expected = std::max(expected, glm::distance(glm::dvec3(a), glm::dvec3(b)));
      }
    }
    EXPECT_DOUBLE_EQ(diameter(mesh), expected) << "cloud " << cloud;
  }
}

TEST(MeshTest, DiameterOfKnownShapes) {
  EXPECT_NEAR(diameter(test::meshOf({{{0, 0, 0}, {3, 4, 12}}})), 13.0, 1e-6);
  Mesh point;
  point.vertices = {{5, 5, 5}, {5, 5, 5}};
  EXPECT_EQ(diameter(point), 0.0);
  // All vertices are equally far from the centre: nothing can be skipped, the answer must still be
  // right.
  Mesh ring;
  for (int i = 0; i < 101; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / 101;
    ring.vertices.emplace_back(20.0 * std::cos(angle), 20.0 * std::sin(angle), 0.0);
  }
  EXPECT_NEAR(diameter(ring), 40.0 * std::cos(3.14159265358979 / 202), 1e-4);
}

TEST(MeshTest, BoundingSphereHoldsEveryVertexAndTouchesOne) {
  Random random(2);
  for (int cloud = 0; cloud < 60; ++cloud) {
    const Mesh mesh = randomCloud(random, 1 + random.index(200));
    const Sphere sphere = boundingSphere(mesh);
    double farthest = 0.0;
    for (const glm::vec3& vertex : mesh.vertices) {
      farthest = std::max(farthest, glm::distance(glm::dvec3(vertex), sphere.center_mm));
    }
    EXPECT_LE(farthest, sphere.radius_mm) << "views of this part would be cut off";
    EXPECT_GE(farthest, sphere.radius_mm * (1.0 - 1e-12)) << "views would waste pixels";
  }
}

TEST(MeshTest, BoundingBoxDiagonalOfABox) {
  EXPECT_NEAR(boundingBoxDiagonal(test::meshOf({{{1, 1, 1}, {4, 5, 13}}})), 13.0, 1e-6);
}

TEST(MeshTest, ThicknessIsThatOfThePlateHoweverItIsTurned) {
  Mesh plate = test::meshOf({{{0, 0, 0}, {80, 50, 3}}});
  EXPECT_NEAR(thickness(plate), 3.0, 1e-4);
  const glm::dmat3 turn = rotationFromVector({0.3, -0.8, 1.1});
  for (glm::vec3& vertex : plate.vertices) vertex = glm::vec3(turn * glm::dvec3(vertex));
  EXPECT_NEAR(thickness(plate), 3.0, 1e-4);
}

}  // namespace
}  // namespace rangepose
