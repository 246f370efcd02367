// A mesh that is wrongly taken for a solid is drawn without the faces that one looks at.
#include "geometry/solid.h"

#include <gtest/gtest.h>

#include <utility>

#include "support/box_mesh.h"

namespace rangepose {
namespace {

Mesh bracketMesh() { return test::meshOf(test::bracketBoxes()); }

void turnInsideOut(Mesh& mesh, std::size_t first_triangle = 0) {
  for (std::size_t i = first_triangle; i < mesh.triangles.size(); ++i)
    std::swap(mesh.triangles[i].y, mesh.triangles[i].z);
}

TEST(SolidTest, ClosedPartsAreSolids) {
  EXPECT_TRUE(isClosed(bracketMesh()));
  EXPECT_TRUE(isSolid(bracketMesh())) << "two boxes that touch";
  Mesh far = bracketMesh();
  for (glm::vec3& vertex : far.vertices) vertex += glm::vec3(5000.0f, -3000.0f, 9000.0f);
  EXPECT_TRUE(isSolid(far)) << "the origin need not lie in the part";
}

TEST(SolidTest, AHoleOpensTheSurface) {
  Mesh mesh = bracketMesh();
  mesh.triangles.pop_back();
  EXPECT_FALSE(isClosed(mesh));
  EXPECT_FALSE(isSolid(mesh));
  EXPECT_FALSE(isSolid(Mesh{}));
}

TEST(SolidTest, FacesWithVerticesOfTheirOwnAreOneSurface) {
  const Mesh mesh = bracketMesh();
  Mesh apart;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const auto first = static_cast<unsigned>(apart.vertices.size());
    for (int k = 0; k < 3; ++k) apart.vertices.push_back(mesh.vertices[triangle[k]]);
    apart.triangles.emplace_back(first, first + 1, first + 2);
  }
  EXPECT_TRUE(isClosed(apart)) << "as each STL file has them";
  EXPECT_TRUE(isSolid(apart));
}

TEST(SolidTest, FacesMustLookOutwards) {
  Mesh mesh = bracketMesh();
  turnInsideOut(mesh);
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_FALSE(isSolid(mesh));
  mesh = bracketMesh();
  std::swap(mesh.triangles[3].y, mesh.triangles[3].z);
  EXPECT_FALSE(isClosed(mesh)) << "one face against its neighbours";
}

TEST(SolidTest, EachOfSeveralSurfacesMustLookOutwards) {
  Mesh mesh = test::meshOf({{{0, 0, 0}, {40, 40, 40}}, {{60, 0, 0}, {70, 10, 10}}});
  EXPECT_TRUE(isSolid(mesh));
  turnInsideOut(mesh, 12);
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_FALSE(isSolid(mesh)) << "the larger box must not outweigh the smaller";
}

TEST(SolidTest, ASheetWithoutThicknessIsNone) {
  EXPECT_FALSE(isSolid(test::meshOf({{{0, 0, 0}, {40, 30, 0}}})));
}

}  // namespace
}  // namespace rangepose
