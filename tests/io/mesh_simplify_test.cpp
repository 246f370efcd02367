#include "io/mesh_simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/solid.h"
#include "geometry/surface_sample.h"
#include "geometry/triangle_corners.h"
#include "geometry/triangle_tree.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

/// A sheet of cells x cells squares of 1 mm in the plane z = 0.
Mesh sheet(unsigned cells) {
  Mesh mesh;
  mesh.name = "sheet";
  for (unsigned y = 0; y <= cells; ++y) {
    for (unsigned x = 0; x <= cells; ++x) mesh.vertices.emplace_back(x, y, 0.0f);
  }
  for (unsigned y = 0; y < cells; ++y) {
    for (unsigned x = 0; x < cells; ++x) {
      const unsigned a = y * (cells + 1) + x;
      const unsigned b = a + cells + 1;
      mesh.triangles.emplace_back(a, a + 1, b + 1);
      mesh.triangles.emplace_back(a, b + 1, b);
    }
  }
  return mesh;
}

Mesh ball(double radius_mm, int around) {
  Mesh mesh;
  mesh.name = "ball";
  const int rings = around / 2;
  mesh.vertices.emplace_back(0.0, 0.0, radius_mm);
  for (int i = 1; i < rings; ++i) {
    const double down = std::numbers::pi * i / rings;
    for (int j = 0; j < around; ++j) {
      const double turn = 2.0 * std::numbers::pi * j / around;
      mesh.vertices.emplace_back(radius_mm * glm::dvec3(std::sin(down) * std::cos(turn),
                                                        std::sin(down) * std::sin(turn),
                                                        std::cos(down)));
    }
  }
  const auto last = static_cast<unsigned>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, -radius_mm);
  const auto at = [&](int ring, int j) {
    if (ring == 0) return 0u;
    if (ring == rings) return last;
    return static_cast<unsigned>(1 + (ring - 1) * around + j % around);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) mesh.triangles.emplace_back(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  }
  return mesh;
}

double areaOf(const Mesh& mesh) { return cumulativeAreas(mesh).back(); }

/// Of points spread over the first surface from the second, one triangle after the other.
double farthest(const Mesh& from, const Mesh& to) {
  constexpr int kPoints = 500;
  double farthest_mm = 0.0;
  for (const glm::dvec3& point : surfaceSample(from, kPoints)) {
    double nearest_mm = std::numeric_limits<double>::max();
    for (const glm::uvec3& triangle : to.triangles) {
      const TriangleCorners at(to, triangle);
      const glm::dvec3 there = nearestOnTriangle(point, at.a, at.b, at.c);
      nearest_mm = std::min(nearest_mm, glm::distance(point, there));
    }
    farthest_mm = std::max(farthest_mm, nearest_mm);
  }
  return farthest_mm;
}

TEST(SimplifiedMeshTest, AFlatSheetKeepsItsOutline) {
  const Mesh result = simplified(sheet(40), 0.01);
  EXPECT_LE(result.triangles.size(), 200u) << "of 3,200: what is flat costs time";
  EXPECT_NEAR(areaOf(result), 1600.0, 1e-6);
  EXPECT_EQ(result.name, "sheet");
}

TEST(SimplifiedMeshTest, MoreErrorLeavesFewerTriangles) {
  const Mesh fine = ball(20.0, 140);
  ASSERT_TRUE(isSolid(fine));
  const Mesh near = simplified(fine, 0.01);
  const Mesh far = simplified(fine, 0.1);
  EXPECT_LT(near.triangles.size(), fine.triangles.size());
  EXPECT_LT(2 * far.triangles.size(), near.triangles.size());
  EXPECT_LE(farthest(fine, near), 0.01 + 1e-6);
  EXPECT_LE(farthest(fine, far), 0.1 + 1e-6);
  EXPECT_TRUE(isSolid(far)) << "backs of faces would be drawn: twice the time";
}

TEST(SimplifiedMeshTest, NoErrorKeepsEveryTriangle) {
  const Mesh mesh = sheet(4);
  const Mesh result = simplified(mesh, 0.0);
  EXPECT_EQ(result.vertices, mesh.vertices);
  EXPECT_EQ(result.triangles, mesh.triangles);
}

TEST(SimplifiedMeshTest, ThreeFacesOnAnEdgeStayAsTheyAre) {
  Mesh mesh = sheet(4);
  mesh.vertices.emplace_back(0.5f, 0.0f, 1.0f);
  mesh.vertices.emplace_back(0.5f, 0.0f, -1.0f);
  const auto count = static_cast<unsigned>(mesh.vertices.size());
  mesh.triangles.emplace_back(0, 1, count - 2);
  mesh.triangles.emplace_back(0, 1, count - 1);
  EXPECT_EQ(simplified(mesh, 0.1).triangles.size(), mesh.triangles.size())
      << "a face that cannot be told is lost from the part";
}

class SimplifiedPartTest : public testing::TestWithParam<const char*> {};

TEST_P(SimplifiedPartTest, SurfacesStayWhereTheyAre) {
  const std::filesystem::path models(RP_MODELS_DIR);
  const Mesh part = readMesh(models / GetParam(), LengthUnit::kMillimetre);
  const double error_mm = 2e-4 * diameter(part);
  const Mesh result = simplified(part, error_mm);
  EXPECT_LT(result.triangles.size(), part.triangles.size());
  EXPECT_LE(farthest(part, result), error_mm + 1e-6);
  EXPECT_LE(farthest(result, part), error_mm + 1e-6);
  EXPECT_NEAR(areaOf(result), areaOf(part), 1e-3 * areaOf(part));
  EXPECT_TRUE(isSolid(part) && isSolid(result));
  EXPECT_NO_THROW(checkMesh(result));
}

INSTANTIATE_TEST_SUITE_P(Models,
                         SimplifiedPartTest,
                         testing::Values("t_pipe.ply",
                                         "bracket.ply",
                                         "tuning/valve_body.ply",
                                         "reporting/thin_plate.ply"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase_if(name, [](char c) { return c == '/' || c == '.'; });
                           return name;
                         });

}  // namespace
}  // namespace rangepose
