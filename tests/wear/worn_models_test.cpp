// Wear on parts as they come from a CAD system.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "geometry/solid.h"
#include "geometry/triangle_tree.h"
#include "io/mesh_file.h"
#include "wear/wear.h"
#include "wear/worn_meshes.h"

namespace rangepose {
namespace {

std::vector<Mesh> allModels() {
  std::vector<std::filesystem::path> paths;
  const std::filesystem::path models(RP_MODELS_DIR);
  for (const std::filesystem::path& folder :
       {models, models / "fitting", models / "tuning", models / "reporting"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".ply") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Mesh> meshes;
  meshes.reserve(paths.size());
  for (const std::filesystem::path& path : paths)
    meshes.push_back(readMesh(path, LengthUnit::kMillimetre));
  return meshes;
}

TEST(WornModelsTest, StaySolidAndLoseLittle) {
  const std::vector<Mesh> models = allModels();
  ASSERT_GE(models.size(), 21u);
  for (const Mesh& cad : models) {
    for (const double edge_mm : {0.2, 0.5, 2.0}) {
      WearOptions options;
      options.scale = options.hole_closed = options.opening_closed = 0.0;
      options.edge_mm = edge_mm;
      const Mesh worn = wornPart(cad, options, 1).mesh;
      const std::string what = cad.name + ", edges of " + std::to_string(edge_mm) + " mm";
      EXPECT_TRUE(isSolid(worn)) << what;
      EXPECT_LT(volumeOf(worn), volumeOf(cad)) << what;
      EXPECT_GT(volumeOf(worn), 0.97 * volumeOf(cad)) << what;
      EXPECT_LT(areaOf(worn), areaOf(cad)) << what;
      EXPECT_LE(worn.triangles.size(), 4 * cad.triangles.size()) << what;
    }
  }
}

TEST(WornModelsTest, SurfaceStaysNearTheCadAndFacesTheSameWay) {
  for (const Mesh& cad : allModels()) {
    constexpr double kEdge = 0.5;
    WearOptions options;
    options.scale = options.hole_closed = options.opening_closed = 0.0;
    options.edge_mm = kEdge;
    const Mesh worn = wornPart(cad, options, 1).mesh;
    const TriangleTree surface(cad);
    double turned_mm2 = 0.0;
    for (const glm::uvec3& triangle : worn.triangles) {
      const TriangleCorners corners(worn, triangle);
      const glm::dvec3 middle = (corners.a + corners.b + corners.c) / 3.0;
      const NearestPoint nearest = surface.nearest(middle);
      EXPECT_LT(nearest.squared_mm2, 0.36 * kEdge * kEdge) << cad.name;
      const glm::uvec3& below = cad.triangles[static_cast<std::size_t>(nearest.triangle)];
      if (glm::dot(TriangleCorners(cad, below).cross(), corners.cross()) < 0.0)
        turned_mm2 += corners.area();
    }
    // Ledges of 0.01 mm, as where two solids overlap a little, may fold over.
    EXPECT_LT(turned_mm2, 5e-4 * areaOf(cad)) << cad.name;
  }
}

TEST(WornModelsTest, AllWearAtOnceLeavesThemClosed) {
  WearOptions options;
  options.hole_closed = options.opening_closed = options.shiny = 1.0;
  std::set<std::string> without_lid;
  for (const Mesh& cad : allModels()) {
    WearOptions open = options;
    open.hole_closed = open.opening_closed = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const WornPart worn = wornPart(cad, options, seed);
      EXPECT_TRUE(isClosed(worn.mesh)) << cad.name << ", seed " << seed;
      EXPECT_TRUE(isSolid(worn.mesh)) << cad.name << ", seed " << seed;
      EXPECT_LE(worn.mesh.triangles.size(), 4 * cad.triangles.size());
      const WornPart without = wornPart(cad, open, seed);
      EXPECT_NEAR(volumeOf(worn.mesh), volumeOf(without.mesh), 1e-3 * volumeOf(cad));
      if (worn.mesh.triangles.size() == without.mesh.triangles.size()) {
        without_lid.insert(cad.name);
      }
    }
  }
  // These have neither hole nor opening with a sharp plane rim, or too wide a one (cup).
  EXPECT_THAT(
      without_lid,
      testing::UnorderedElementsAre(
          "block", "bolt", "clevis_pin", "cup", "dowel", "pin", "plate", "rod", "star_knob"));
}

}  // namespace
}  // namespace rangepose
