// Flat faces of parts, and the thickness of sheet metal.
#include "geometry/flat_faces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/pose.h"
#include "geometry/surface_sample.h"
#include "solids.h"
#include "support/box_mesh.h"

namespace rangepose {
namespace {

constexpr double kToleranceMm = 1.0;

Mesh turned(Mesh mesh) {
  const glm::dmat3 turn = rotationFromVector({0.3, -0.8, 1.1});
  for (glm::vec3& vertex : mesh.vertices) vertex = glm::vec3(turn * glm::dvec3(vertex));
  return mesh;
}

/// An L of 2 mm sheet, 60 x 40 and 40 x 30 mm. Its legs meet in an edge and nowhere else.
Mesh bentSheet() { return test::meshOf({{{0, 0, 0}, {60, 40, 2}}, {{-2, 0, 2}, {0, 40, 32}}}); }

TEST(FlatFacesTest, ExtentOfABoxIsThatOfItsLargestFace) {
  const Mesh box = test::meshOf({{{0, 0, 0}, {60, 40, 20}}});
  for (const Mesh& mesh : {box, turned(box)}) {
    const PlaneExtent extent = largestExtent(flatFaces(mesh, kToleranceMm));
    EXPECT_NEAR(extent.length_mm, 60.0, 1e-3);
    EXPECT_NEAR(extent.width_mm, 40.0, 1e-3);
  }
}

TEST(FlatFacesTest, ExtentInAPlaneIsThatOfARectangle) {
  const glm::dmat3 turn = rotationFromVector({0.7, 0.2, -1.3});
  const glm::dmat3 diagonal(30.0 * 30.0 / 12.0, 0, 0, 0, 50.0 * 50.0 / 12.0, 0, 0, 0, 9.0);
  const glm::dmat3 covariance = turn * diagonal * glm::transpose(turn);
  const PlaneExtent extent = extentInPlane(covariance, turn[2]);
  EXPECT_NEAR(extent.length_mm, 50.0, 1e-9);
  EXPECT_NEAR(extent.width_mm, 30.0, 1e-9);
}

TEST(FlatFacesTest, BentSheetIsAsThickAsTheSheetNotAsItsBox) {
  for (const Mesh& mesh : {bentSheet(), turned(bentSheet())}) {
    EXPECT_GT(thickness(mesh), 20.0);
    EXPECT_NEAR(sheetThickness(flatFaces(mesh, kToleranceMm)), 2.0, 1e-4)
        << "its two sides, or it and what it lies on, would be taken for one surface";
  }
}

TEST(FlatFacesTest, ThicknessOfABoxIsItsSmallestSide) {
  const Mesh box = test::meshOf({{{0, 0, 0}, {60, 40, 20}}});
  EXPECT_NEAR(sheetThickness(flatFaces(box, kToleranceMm)), 20.0, 1e-4);
}

/// The wall of a pipe is thin, but nothing can be confused with its other side.
TEST(FlatFacesTest, RoundPartsAreNoSheet) {
  for (const double height : {20.0, 80.0}) {
    const Mesh cylinder = test::prism(48, 15.0, height);
    EXPECT_TRUE(std::isinf(sheetThickness(flatFaces(cylinder, 0.3)))) << height << " mm long";
  }
}

TEST(FlatFacesTest, TrianglesWithoutAreaDoNoHarm) {
  Mesh mesh = bentSheet();
  for (int i = 0; i < 100; ++i) mesh.triangles.insert(mesh.triangles.begin(), glm::uvec3(0, 1, 1));
  const std::vector<FlatFace> faces = flatFaces(mesh, kToleranceMm);
  EXPECT_NEAR(sheetThickness(faces), 2.0, 1e-4);
  EXPECT_TRUE(std::isfinite(largestExtent(faces).length_mm));
}

TEST(FlatFacesTest, AMeshWithoutFacesIsRefused) {
  EXPECT_THROW(flatFaces(Mesh{}, kToleranceMm), Error);
}

}  // namespace
}  // namespace rangepose
