#include "sim/heap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "sim/random.h"
#include "sim_meshes.h"

namespace rangepose {
namespace {

HeapOptions smallHeap() {
  HeapOptions options;
  options.count = 7;
  options.radius_mm = 40.0;
  options.nudges = 60;
  options.seed = 11;
  return options;
}

/// Evenly spread over the faces.
std::vector<glm::dvec3> surfacePoints(const Mesh& mesh, int per_face, Random& random) {
  std::vector<glm::dvec3> points(mesh.vertices.begin(), mesh.vertices.end());
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < per_face; ++k) {
      const double s = random.uniform();
      const double t = random.uniform() * (1.0 - s);
      points.push_back((1.0 - s - t) * glm::dvec3(mesh.vertices[triangle.x]) +
                       s * glm::dvec3(mesh.vertices[triangle.y]) +
                       t * glm::dvec3(mesh.vertices[triangle.z]));
    }
  }
  return points;
}

int pointsInside(const std::vector<glm::dvec3>& points,
                 const Pose& of_points,
                 const Mesh& mesh,
                 const Pose& pose) {
  const Pose mesh_from_points = pose.inverse() * of_points;
  int inside = 0;
  for (const glm::dvec3& point : points) inside += isInside(mesh, mesh_from_points * point) ? 1 : 0;
  return inside;
}

TEST(HeapTest, CentreOfMassOfTwoBoxes) {
  const glm::dvec3 center = centerOfMass(angleMesh());
  // 60x15 at (30, 7.5) and 15x35 at (7.5, 32.5).
  const double first = 60.0 * 15.0;
  const double second = 15.0 * 35.0;
  EXPECT_NEAR(center.x, (first * 30.0 + second * 7.5) / (first + second), 1e-5);
  EXPECT_NEAR(center.y, (first * 7.5 + second * 32.5) / (first + second), 1e-5);
  EXPECT_NEAR(center.z, 10.0, 1e-5);
}

TEST(HeapTest, PartsShareNoSpace) {
  const std::vector<Mesh> meshes = {angleMesh(), boxMesh({-25, -12, -6}, {25, 12, 6})};
  const std::vector<PlacedPart> heap = makeHeap(meshes, smallHeap());
  Random random(1);
  std::vector<std::vector<glm::dvec3>> points;
  points.reserve(meshes.size());
  for (const Mesh& mesh : meshes) points.push_back(surfacePoints(mesh, 200, random));
  int near_pairs = 0;
  for (std::size_t a = 0; a < heap.size(); ++a) {
    for (std::size_t b = 0; b < heap.size(); ++b) {
      if (a == b) continue;
      const auto mesh_a = static_cast<std::size_t>(heap[a].mesh);
      const auto mesh_b = static_cast<std::size_t>(heap[b].mesh);
      EXPECT_EQ(
          pointsInside(
              points[mesh_a], heap[a].world_from_object, meshes[mesh_b], heap[b].world_from_object),
          0)
          << "part " << a << " in part " << b;
      // The same check must see a part that is pushed down by 3 mm, or it proves nothing.
      Pose pushed = heap[a].world_from_object;
      pushed.translation_mm.z -= 3.0;
      near_pairs +=
          pointsInside(points[mesh_a], pushed, meshes[mesh_b], heap[b].world_from_object) > 0;
    }
  }
  EXPECT_GT(near_pairs, 0);
}

TEST(HeapTest, PartsLieOnTheTableOrOnParts) {
  const std::vector<Mesh> meshes = {boxMesh({-30, -20, -5}, {30, 20, 5})};
  HeapOptions options = smallHeap();
  options.nudges = 300;
  double lowest = 1e9;
  for (const PlacedPart& part : makeHeap(meshes, options)) {
    double lowest_of_part = 1e9;
    for (const glm::vec3& vertex : meshes[0].vertices) {
      lowest_of_part = std::min(lowest_of_part, (part.world_from_object * glm::dvec3(vertex)).z);
    }
    EXPECT_GT(lowest_of_part, -1e-3);
    lowest = std::min(lowest, lowest_of_part);
  }
  EXPECT_NEAR(lowest, 0.0, 1e-3);
}

TEST(HeapTest, FirstPartComesToRestFlat) {
  const std::vector<Mesh> meshes = {boxMesh({-30, -20, -5}, {30, 20, 5})};
  HeapOptions options;
  options.count = 1;
  options.nudges = 400;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    options.seed = seed;
    const Pose pose = makeHeap(meshes, options).at(0).world_from_object;
    // The lowest of several drops nudged downhill ends on the largest face: 5 mm above the table.
    EXPECT_NEAR(pose.translation_mm.z, 5.0, 1.0) << "seed " << seed;
    EXPECT_GT(std::abs(pose.rotation[2].z), 0.998) << "seed " << seed;
  }
}

TEST(HeapTest, SameSeedSameHeap) {
  const std::vector<Mesh> meshes = {angleMesh()};
  HeapOptions options = smallHeap();
  options.count = 4;
  const std::vector<PlacedPart> first = makeHeap(meshes, options);
  const std::vector<PlacedPart> again = makeHeap(meshes, options);
  options.seed += 1;
  const std::vector<PlacedPart> other = makeHeap(meshes, options);
  ASSERT_EQ(first.size(), 4u);
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(first[k].world_from_object.rotation, again[k].world_from_object.rotation);
    EXPECT_EQ(first[k].world_from_object.translation_mm, again[k].world_from_object.translation_mm);
    EXPECT_NE(first[k].world_from_object.translation_mm, other[k].world_from_object.translation_mm);
  }
}

TEST(HeapTest, BadInputIsRefused) {
  HeapOptions options;
  EXPECT_THROW(makeHeap({}, options), Error);
  options.count = 0;
  EXPECT_THROW(makeHeap({angleMesh()}, options), Error);
  options = {};
  Mesh inside_out = angleMesh();
  for (glm::uvec3& triangle : inside_out.triangles) std::swap(triangle.x, triangle.y);
  EXPECT_THROW(makeHeap({inside_out}, options), Error);
}

}  // namespace
}  // namespace rangepose
