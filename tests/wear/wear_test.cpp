#include "wear/wear.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "geometry/solid.h"
#include "geometry/triangle_tree.h"
#include "sim/sim_meshes.h"
#include "wear/worn_meshes.h"

namespace rangepose {
namespace {

/// Nothing but rounded edges.
WearOptions onlyEdges(double edge_mm) {
  WearOptions options;
  options.scale = options.hole_closed = options.opening_closed = options.shiny = 0.0;
  options.edge_mm = edge_mm;
  return options;
}

const Mesh kBox = boxMesh({-20, -15, -10}, {20, 15, 10});
constexpr double kBoxVolume = 40.0 * 30.0 * 20.0;
constexpr double kBoxEdges = 4.0 * (40.0 + 30.0 + 20.0);

/// A post on a plate: four edges between them are concave.
Mesh postOnPlate() {
  // The plate's upper face has no hole below the post: walls go down to the plate's lower face, and
  // the faces between them are left out.
  Mesh mesh = plateWithHole(20.0, 8.0, 5.0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (i % 4 == 2) mesh.vertices[i].z = 5.0f;
  }
  const auto first = static_cast<unsigned>(mesh.vertices.size());
  for (unsigned i = 0; i < 48; ++i) {
    mesh.vertices.emplace_back(mesh.vertices[4 * i + 2].x, mesh.vertices[4 * i + 2].y, 25.0f);
  }
  mesh.vertices.emplace_back(0.0f, 0.0f, 25.0f);
  mesh.vertices.emplace_back(0.0f, 0.0f, 0.0f);
  Mesh result;
  result.name = "post";
  result.vertices = mesh.vertices;
  for (const glm::uvec3& t : mesh.triangles) {
    const bool wall = t.x % 4 >= 2 && t.y % 4 >= 2 && t.z % 4 >= 2;
    if (!wall) result.triangles.push_back(t);
  }
  for (unsigned i = 0; i < 48; ++i) {
    const unsigned j = (i + 1) % 48;
    result.triangles.emplace_back(4 * i + 2, 4 * j + 2, first + j);
    result.triangles.emplace_back(4 * i + 2, first + j, first + i);
    result.triangles.emplace_back(first + i, first + j, first + 48);
    result.triangles.emplace_back(4 * j + 3, 4 * i + 3, first + 49);
  }
  return result;
}

TEST(WearTest, RoundedBoxStaysClosedAndLosesItsEdges) {
  const Mesh worn = wornPart(kBox, onlyEdges(0.5), 1).mesh;
  EXPECT_TRUE(isManifold(worn));
  EXPECT_TRUE(isSolid(worn));
  // A quarter of a round leaves (1 - pi / 4) r^2 of the corner's square outside: 0.215; two strips
  // cut it a little more.
  const double lost = kBoxVolume - volumeOf(worn);
  EXPECT_GT(lost, 0.215 * 0.25 * (kBoxEdges - 12.0));
  EXPECT_LT(lost, 0.300 * 0.25 * kBoxEdges);
  // Faces keep their planes.
  EXPECT_NEAR(boundingBoxDiagonal(worn), boundingBoxDiagonal(kBox), 1e-4);
}

TEST(WearTest, NothingMovesFartherThanTheEdgesRadius) {
  constexpr double kEdge = 0.8;
  for (const Mesh& cad : {kBox, plateWithHole(30.0, 6.0, 8.0), tubeMesh(15.0, 11.0, 40.0)}) {
    const Mesh worn = wornPart(cad, onlyEdges(kEdge), 1).mesh;
    const TriangleTree cad_surface(cad);
    const TriangleTree worn_surface(worn);
    bool any_moved = false;
    for (const glm::vec3& vertex : worn.vertices) {
      EXPECT_TRUE(cad_surface.touches(vertex, 0.6 * kEdge)) << cad.name;
      any_moved = any_moved || !cad_surface.touches(vertex, 0.1 * kEdge);
    }
    for (const glm::vec3& vertex : cad.vertices)
      EXPECT_TRUE(worn_surface.touches(vertex, 0.8 * kEdge)) << cad.name;
    EXPECT_TRUE(any_moved) << cad.name;
  }
}

TEST(WearTest, ThinWallsAreNotTurnedInsideOut) {
  // Radii wider than the walls.
  for (const Mesh& cad : {tubeMesh(15.0, 14.2, 40.0),
                          boxMesh({0, 0, 0}, {50, 40, 0.6}),
                          plateWithHole(8.0, 7.5, 1.0)}) {
    const Mesh worn = wornPart(cad, onlyEdges(3.0), 1).mesh;
    EXPECT_TRUE(isManifold(worn)) << cad.name;
    EXPECT_TRUE(isSolid(worn)) << cad.name;
    EXPECT_LT(volumeOf(worn), volumeOf(cad)) << cad.name;
    EXPECT_GT(volumeOf(worn), 0.85 * volumeOf(cad)) << cad.name;
    EXPECT_LT(areaOf(worn), areaOf(cad)) << cad.name;
  }
}

TEST(WearTest, ConcaveEdgesKeepTheirPlace) {
  const Mesh cad = postOnPlate();
  ASSERT_TRUE(isSolid(cad));
  const Mesh worn = wornPart(cad, onlyEdges(0.5), 1).mesh;
  EXPECT_TRUE(isManifold(worn));
  EXPECT_TRUE(isSolid(worn));
  const TriangleTree surface(worn);
  EXPECT_TRUE(surface.touches({8.0, 0.0, 5.0}, 1e-4)) << "between plate and post";
  EXPECT_FALSE(surface.touches({8.0, 0.0, 25.0}, 0.15)) << "the post's end";
}

TEST(WearTest, EdgesOfMoreThanTwoFacesStayAndTheRestIsRounded) {
  // Two boxes that share an edge, as one surface.
  Mesh cad = test::meshOf({{{0, 0, 0}, {20, 20, 20}}, {{20, 20, 0}, {40, 40, 20}}});
  const Mesh worn = wornPart(cad, onlyEdges(0.5), 1).mesh;
  EXPECT_TRUE(isClosed(worn));
  EXPECT_LT(volumeOf(worn), volumeOf(cad) - 10.0);
  const TriangleTree surface(worn);
  EXPECT_TRUE(surface.touches({20.0, 20.0, 10.0}, 1e-4)) << "the shared edge";
  EXPECT_FALSE(surface.touches({0.0, 0.0, 10.0}, 0.15)) << "another edge";
}

TEST(WearTest, SeamsOfTheFileDoNotMatter) {
  Mesh soup;
  for (const glm::uvec3& triangle : kBox.triangles) {
    const auto first = static_cast<unsigned>(soup.vertices.size());
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(kBox.vertices[triangle[k]]);
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  const Mesh worn = wornPart(soup, onlyEdges(0.5), 1).mesh;
  EXPECT_TRUE(isManifold(worn));
  EXPECT_NEAR(volumeOf(worn), volumeOf(wornPart(kBox, onlyEdges(0.5), 1).mesh), 0.01);
}

TEST(WearTest, FineMeshesAreRoundedAsMuchAsCoarseOnes) {
  const Mesh coarse = boxMesh({0, 0, 0}, {10, 8, 6});
  Mesh fine = coarse;
  for (int k = 0; k < 4; ++k) fine = quartered(fine);  // vertices 0.4 to 0.6 mm apart
  const Mesh worn = wornPart(fine, onlyEdges(0.5), 1).mesh;
  EXPECT_TRUE(isManifold(worn));
  EXPECT_TRUE(isSolid(worn));
  const double expected = volumeOf(coarse) - volumeOf(wornPart(coarse, onlyEdges(0.5), 1).mesh);
  EXPECT_NEAR(volumeOf(fine) - volumeOf(worn), expected, 0.3 * expected);
}

TEST(WearTest, WithoutWearThePartIsItsCad) {
  const Mesh worn = wornPart(kBox, onlyEdges(0.0), 1).mesh;
  EXPECT_EQ(worn.triangles.size(), kBox.triangles.size());
  EXPECT_NEAR(volumeOf(worn), kBoxVolume, 1e-6);
}

TEST(WearTest, HoleIsClosedAtBothEnds) {
  const Mesh cad = plateWithHole(30.0, 4.0, 8.0);
  WearOptions options = onlyEdges(0.3);
  const glm::dvec2 inside(0.31, 0.17);
  EXPECT_EQ(facesAbove(wornPart(cad, options, 1).mesh, inside), (std::array<int, 2>{0, 0}));
  options.hole_closed = 1.0;
  const Mesh worn = wornPart(cad, options, 1).mesh;
  // Two lids, each with a face to either side.
  EXPECT_EQ(facesAbove(worn, inside), (std::array<int, 2>{2, 2}));
  const TriangleTree surface(worn);
  EXPECT_TRUE(surface.touches({0.31, 0.17, 0.0}, 0.2));
  EXPECT_TRUE(surface.touches({0.31, 0.17, 8.0}, 0.2));
  EXPECT_TRUE(isClosed(worn));
}

TEST(WearTest, OpeningIsClosedAtOneEnd) {
  const Mesh cad = tubeMesh(15.0, 11.0, 40.0);
  WearOptions options = onlyEdges(0.3);
  options.hole_closed = 1.0;  // too wide to be one
  const glm::dvec2 inside(0.31, 0.17);
  EXPECT_EQ(facesAbove(wornPart(cad, options, 1).mesh, inside), (std::array<int, 2>{0, 0}));
  options.opening_closed = 1.0;
  std::set<bool> at_top;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Mesh worn = wornPart(cad, options, seed).mesh;
    EXPECT_EQ(facesAbove(worn, inside), (std::array<int, 2>{1, 1}));
    const TriangleTree surface(worn);
    at_top.insert(surface.touches({0.31, 0.17, 40.0}, 0.2));
    // Flush, and the rim around it is no lid.
    EXPECT_TRUE(surface.touches({0.31, 0.17, *at_top.rbegin() ? 40.0 : 0.0}, 0.2) ||
                surface.touches({0.31, 0.17, 0.0}, 0.2));
    EXPECT_EQ(facesAbove(worn, {13.0, 0.1}), (std::array<int, 2>{1, 1}));
  }
  EXPECT_EQ(at_top.size(), 2u) << "always the same end";
}

TEST(WearTest, EndsOfFullPartsAreNoOpenings) {
  WearOptions options = onlyEdges(0.3);
  for (const Mesh& cad : {rodMesh(10.0, 50.0), kBox, postOnPlate()}) {
    options.hole_closed = options.opening_closed = 0.0;
    const std::size_t count = wornPart(cad, options, 1).mesh.triangles.size();
    options.hole_closed = options.opening_closed = 1.0;
    EXPECT_EQ(wornPart(cad, options, 1).mesh.triangles.size(), count) << cad.name;
  }
}

TEST(WearTest, ShinyFaceIsOneFaceOfThePart) {
  WearOptions options;
  options.shiny = 1.0;
  std::set<int> axes;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const WornPart worn = wornPart(kBox, options, seed);
    const double share = areaOf(worn.shiny) / areaOf(worn.mesh);
    EXPECT_GT(share, 0.05);
    EXPECT_LT(share, 0.25);
    std::set<std::tuple<float, float, float>> places;
    for (const glm::vec3& v : worn.mesh.vertices) places.emplace(v.x, v.y, v.z);
    glm::vec3 low = worn.shiny.vertices.at(0);
    glm::vec3 high = low;
    for (const glm::vec3& v : worn.shiny.vertices) {
      EXPECT_EQ(places.count({v.x, v.y, v.z}), 1u) << "off the part";
      low = glm::min(low, v);
      high = glm::max(high, v);
    }
    int flat = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (low[axis] != high[axis]) continue;
      ++flat;
      axes.insert(2 * axis + (low[axis] > 0.0f ? 1 : 0));
    }
    EXPECT_EQ(flat, 1);
  }
  EXPECT_EQ(axes.size(), 6u) << "some faces are never shiny";
}

TEST(WearTest, SizeIsOffByUpToTheScaleAboutTheMiddle) {
  const Mesh cad = boxMesh({100, 50, 0}, {140, 80, 20});
  WearOptions options = onlyEdges(0.0);
  options.scale = 0.02;
  const Sphere sphere = boundingSphere(cad);
  double smallest = 2.0;
  double largest = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Sphere worn = boundingSphere(wornPart(cad, options, seed).mesh);
    EXPECT_NEAR(glm::distance(worn.center_mm, sphere.center_mm), 0.0, 1e-4);
    smallest = std::min(smallest, worn.radius_mm / sphere.radius_mm);
    largest = std::max(largest, worn.radius_mm / sphere.radius_mm);
  }
  EXPECT_GT(smallest, 0.9799);
  EXPECT_LT(smallest, 0.983);
  EXPECT_LT(largest, 1.0201);
  EXPECT_GT(largest, 1.017);
}

TEST(WearTest, SameSeedSamePart) {
  WearOptions options;
  options.hole_closed = options.opening_closed = options.shiny = 0.5;
  const Mesh cad = plateWithHole(30.0, 4.0, 8.0);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const WornPart a = wornPart(cad, options, seed);
    const WornPart b = wornPart(cad, options, seed);
    EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
    EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
    EXPECT_EQ(a.shiny.vertices, b.shiny.vertices);
    EXPECT_NE(a.mesh.vertices, wornPart(cad, options, seed + 1).mesh.vertices);
  }
}

TEST(WearTest, OneChanceLeavesTheOthersAlone) {
  WearOptions options;
  options.shiny = 1.0;
  const Mesh cad = plateWithHole(30.0, 4.0, 8.0);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    options.hole_closed = 0.0;
    const WornPart open = wornPart(cad, options, seed);
    options.hole_closed = 1.0;
    const WornPart closed = wornPart(cad, options, seed);
    EXPECT_GT(closed.mesh.triangles.size(), open.mesh.triangles.size());
    EXPECT_EQ(closed.mesh.vertices.at(0), open.mesh.vertices.at(0)) << "another size";
    EXPECT_EQ(closed.shiny.vertices, open.shiny.vertices) << "another face";
  }
}

TEST(WearTest, BadOptionsAreRefused) {
  const auto refused = [](auto change) {
    WearOptions options;
    change(options);
    EXPECT_THROW(wornPart(kBox, options, 1), Error);
  };
  refused([](WearOptions& o) { o.scale = -0.01; });
  refused([](WearOptions& o) { o.scale = 0.5; });
  refused([](WearOptions& o) { o.edge_mm = -1.0; });
  refused([](WearOptions& o) { o.hole_closed = 1.5; });
  refused([](WearOptions& o) { o.opening_closed = -0.1; });
  refused([](WearOptions& o) { o.shiny = 2.0; });
  EXPECT_THROW(wornPart({}, {}, 1), Error);
}

}  // namespace
}  // namespace rangepose
