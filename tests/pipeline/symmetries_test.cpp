// The symmetries that pose errors are forgiven for must be ones of the parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "io/mesh_file.h"
#include "support/oracle.h"
#include "support/part_symmetries.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

constexpr int kPoints = 250;
/// Facets of the round faces differ by this much under a turn.
constexpr double kFacetMm = 0.6;

Mesh model(const std::string& part) {
  return readMesh(std::filesystem::path(RP_MODELS_DIR) / (part + ".ply"), LengthUnit::kMillimetre);
}

/// Points spread over the surface by area.
std::vector<glm::dvec3> surfacePoints(const Mesh& mesh) {
  std::vector<double> sums;
  double sum = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[triangle.x];
    sum += glm::length(glm::cross(glm::dvec3(mesh.vertices[triangle.y]) - a,
                                  glm::dvec3(mesh.vertices[triangle.z]) - a));
    sums.push_back(sum);
  }
  test::Random random(7);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < kPoints; ++i) {
    const auto found = std::lower_bound(sums.begin(), sums.end(), random.uniform(0.0, sum));
    const glm::uvec3& triangle =
        mesh.triangles[static_cast<std::size_t>(std::distance(sums.begin(), found))];
    const glm::dvec3 a = mesh.vertices[triangle.x];
    double s = random.uniform(0.0, 1.0);
    double t = random.uniform(0.0, 1.0);
    if (s + t > 1.0) {
      s = 1.0 - s;
      t = 1.0 - t;
    }
    points.push_back(a + s * (glm::dvec3(mesh.vertices[triangle.y]) - a) +
                     t * (glm::dvec3(mesh.vertices[triangle.z]) - a));
  }
  return points;
}

/// The largest distance of a turned surface to the surface [mm].
double largestGap(const Mesh& mesh, const std::vector<glm::dvec3>& points, const Pose& turn) {
  double largest = 0.0;
  for (const glm::dvec3& point : points) {
    largest = std::max(largest, test::oracle::nearestFace(mesh, turn * point).distance_mm);
  }
  return largest;
}

class SymmetriesTest : public testing::TestWithParam<std::string> {};

TEST_P(SymmetriesTest, MapThePartOntoItself) {
  const Mesh mesh = model(GetParam());
  const std::vector<glm::dvec3> points = surfacePoints(mesh);
  const std::vector<Pose> symmetries = test::symmetriesOf(GetParam(), mesh);
  ASSERT_FALSE(symmetries.empty());
  EXPECT_NEAR(rotationAngleBetween(symmetries.front().rotation, glm::dmat3(1.0)), 0.0, 1e-9);
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    EXPECT_LT(largestGap(mesh, points, symmetries[i]), kFacetMm) << "symmetry " << i;
  }
}

TEST_P(SymmetriesTest, DifferFromEachOther) {
  const Mesh mesh = model(GetParam());
  const std::vector<Pose> symmetries = test::symmetriesOf(GetParam(), mesh);
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(rotationAngleBetween(symmetries[i].rotation, symmetries[j].rotation), 0.5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models,
                         SymmetriesTest,
                         testing::Values("t_pipe", "bolt", "elbow", "bracket"),
                         [](const auto& made) { return made.param; });

TEST(SymmetriesTest, CountsAreThoseOfTheModels) {
  const auto count = [](const char* part) { return test::symmetriesOf(part, model(part)).size(); };
  EXPECT_EQ(count("bolt"), 6u);
  EXPECT_EQ(count("t_pipe"), 2u);
  EXPECT_EQ(count("elbow"), 2u);
  EXPECT_EQ(count("bracket"), 1u);
}

TEST(SymmetriesTest, OtherTurnsDoNotMapThePartOntoItself) {
  const auto gapOf = [](const char* part, const glm::dvec3& turn) {
    const Mesh mesh = model(part);
    const glm::dvec3 center = boundingSphere(mesh).center_mm;
    Pose pose;
    pose.rotation = rotationFromVector(turn);
    pose.translation_mm = center - pose.rotation * center;
    return largestGap(mesh, surfacePoints(mesh), pose);
  };
  constexpr double kPi = std::numbers::pi;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 turn(0.0);
    turn[axis] = kPi;
    EXPECT_GT(gapOf("bracket", turn), 2.0) << "half turn about axis " << axis;
  }
  EXPECT_GT(gapOf("bolt", {0.0, 0.0, kPi / 6.0}), 0.8);
  EXPECT_GT(gapOf("t_pipe", {0.0, 0.0, kPi / 2.0}), 2.0);
}

TEST(VertexErrorTest, ForgivesSymmetriesAndMeasuresShifts) {
  const Mesh mesh = model("bolt");
  const std::vector<Pose> symmetries = test::symmetriesOf("bolt", mesh);
  const Pose truth{rotationFromVector({0.3, -1.1, 0.7}), {10.0, -20.0, 600.0}};
  EXPECT_NEAR(test::vertexError(mesh, symmetries, truth * symmetries[4], truth), 0.0, 1e-9);
  Pose shifted = truth * symmetries[2];
  shifted.translation_mm += glm::dvec3(0.0, 3.0, 4.0);
  EXPECT_NEAR(test::vertexError(mesh, symmetries, shifted, truth), 5.0, 1e-9);
  EXPECT_GT(test::vertexError(mesh, {Pose{}}, truth * symmetries[3], truth), 5.0);
}

}  // namespace
}  // namespace rangepose
