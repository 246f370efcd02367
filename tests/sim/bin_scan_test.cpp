#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/error.h"
#include "sim/scanner.h"
#include "sim/sim_meshes.h"

namespace rangepose {
namespace {

const BinShape kBin{{300.0, 200.0, 120.0}};

/// One block in the middle of the bin.
struct Scene {
  std::vector<Mesh> meshes = {boxMesh({-30, -20, 0}, {30, 20, 40})};
  std::vector<PlacedPart> parts = {{0, Pose{}}};
};

ScannerOptions options(const std::string& sensor) {
  ScannerOptions scanner;
  scanner.width = 320;
  scanner.height = 240;
  scanner.distance_mm = 0.0;
  scanner.sensor = sensorModel(sensor);
  return scanner;
}

float depthAt(const Scan& scan, const glm::dvec3& world_mm) {
  const glm::dvec2 pixel = scan.image.camera.project(scan.camera_from_world * world_mm);
  const int u = static_cast<int>(std::lround(pixel.x));
  const int v = static_cast<int>(std::lround(pixel.y));
  return scan.image.depth_mm.contains(u, v) ? scan.image.depth_mm.at(u, v) : -1.0f;
}

double depthOfPoint(const Scan& scan, const glm::dvec3& world_mm) {
  return (scan.camera_from_world * world_mm).z;
}

TEST(BinMeshTest, IsClosedAndFacesOutwards) {
  const Mesh mesh = binMesh(kBin);
  std::map<std::pair<unsigned, unsigned>, int> edges;
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    volume += glm::dot(glm::dvec3(mesh.vertices[t.x]),
                       glm::cross(glm::dvec3(mesh.vertices[t.y]), glm::dvec3(mesh.vertices[t.z]))) /
              6.0;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  const double wall = binThickness(kBin);
  const double outer = (300.0 + 2 * wall) * (200.0 + 2 * wall) * (120.0 + wall);
  EXPECT_NEAR(volume, outer - 300.0 * 200.0 * 120.0, 1.0);
}

TEST(BinScanTest, FloorRimWallAndTableAreSeenWhereTheyAre) {
  const Scene scene;
  const Scan scan = scanBin(scene.meshes, scene.parts, kBin, options("none"));
  const double wall = binThickness(kBin);
  const std::vector<glm::dvec3> seen = {
      {100, 0, 0},                 // floor
      {0, 0, 40},                  // block
      {150 + 0.5 * wall, 0, 120},  // rim
      {0, 100, 80},                // inner wall that faces the camera
      {0, -130, -wall},            // table
  };
  for (const glm::dvec3& point : seen) {
    EXPECT_NEAR(depthAt(scan, point), depthOfPoint(scan, point), 4.0)
        << point.x << " " << point.y << " " << point.z;
  }
  // Seen from aside the near wall hides its own inner face and the floor behind it.
  ScannerOptions aside = options("none");
  aside.tilt_rad = 0.8;
  const Scan hidden = scanBin(scene.meshes, scene.parts, kBin, aside);
  EXPECT_LT(depthAt(hidden, {0, -60, 0}), depthOfPoint(hidden, {0, -60, 0}) - 20.0);
}

TEST(BinScanTest, AllOfTheBinIsInTheImageAndNotMuchElse) {
  const Scene scene;
  for (const bool orthographic : {false, true}) {
    ScannerOptions scanner = options("none");
    scanner.orthographic = orthographic;
    const Scan scan = scanBin(scene.meshes, scene.parts, kBin, scanner);
    double least = 1e9;
    for (const glm::vec3& vertex : binMesh(kBin).vertices) {
      const glm::dvec2 p = scan.image.camera.project(scan.camera_from_world * glm::dvec3(vertex));
      least = std::min({least, p.x, p.y, 319.0 - p.x, 239.0 - p.y});
    }
    EXPECT_GE(least, 0.0);
    EXPECT_LT(least, 12.0);
  }
}

TEST(BinScanTest, OrthographicRaysAreParallel) {
  const Scene scene;
  ScannerOptions scanner = options("none");
  scanner.orthographic = true;
  scanner.tilt_rad = 0.0;
  scanner.pixel_size_mm = 1.5;
  const Scan scan = scanBin(scene.meshes, scene.parts, kBin, scanner);
  EXPECT_TRUE(scan.image.camera.orthographic);
  EXPECT_EQ(scan.image.camera.pixel_size_mm, 1.5);
  // Straight from above no wall is seen: all depths are those of block, floor, rim and table.
  const float floor = static_cast<float>(depthOfPoint(scan, {0, 0, 0}));
  const float wall = static_cast<float>(binThickness(kBin));
  int block_px = 0;
  for (const float z : scan.image.depth_mm) {
    const bool known = std::abs(z - floor) < 1e-2f || std::abs(z - floor + 40.0f) < 1e-2f ||
                       std::abs(z - floor + 120.0f) < 1e-2f || std::abs(z - floor - wall) < 1e-2f;
    ASSERT_TRUE(known) << z - floor;
    block_px += std::abs(z - floor + 40.0f) < 1e-2f ? 1 : 0;
  }
  EXPECT_NEAR(block_px * 1.5 * 1.5, 60.0 * 40.0, 150.0);
  scanner.sensor = sensorModel("structured-light");
  const Scan noisy = scanBin(scene.meshes, scene.parts, kBin, scanner);
  EXPECT_NE(noisy.image.depth_mm, scan.image.depth_mm);
}

TEST(BinScanTest, TruthCountsPixelsAndBoxes) {
  Scene scene;
  scene.meshes.push_back(boxMesh({-10, -10, 0}, {10, 10, 20}));
  scene.parts.push_back({1, Pose{glm::dmat3(1.0), {0, 0, 40}}});
  ScannerOptions scanner = options("none");
  scanner.tilt_rad = 0.0;
  scanner.orthographic = true;
  scanner.pixel_size_mm = 1.0;
  const Scan scan = scanBin(scene.meshes, scene.parts, kBin, scanner);
  const PartTruth& below = scan.truth[0];
  const PartTruth& above = scan.truth[1];
  EXPECT_NEAR(below.all_px, 60 * 40, 110);
  EXPECT_NEAR(above.all_px, 20 * 20, 45);
  EXPECT_EQ(above.visible_px, above.all_px);
  EXPECT_EQ(below.visible_px, below.all_px - above.all_px);
  EXPECT_DOUBLE_EQ(below.visible_fraction, static_cast<double>(below.visible_px) / below.all_px);
  EXPECT_EQ(below.measured_px, below.all_px);  // the part above has depth, too
  EXPECT_EQ(below.all_box, below.visible_box);
  EXPECT_NEAR(below.all_box.width(), 60, 1);
  EXPECT_NEAR(below.all_box.height(), 40, 1);
  EXPECT_NEAR(above.visible_box.x0 - below.visible_box.x0, 20, 1);
  scanner.sensor = sensorModel("rough");
  const Scan rough = scanBin(scene.meshes, scene.parts, kBin, scanner);
  EXPECT_LT(rough.truth[0].measured_px, below.all_px);
  EXPECT_GT(rough.truth[0].measured_px, below.all_px / 2);
  EXPECT_EQ(rough.truth[0].visible_px, below.visible_px);
}

TEST(BinScanTest, APartCutByTheBorderHasABoxBeyondIt) {
  Scene scene;
  ScannerOptions scanner = options("none");
  scanner.tilt_rad = 0.0;
  scanner.orthographic = true;
  scanner.pixel_size_mm = 1.0;
  scene.parts[0].world_from_object.translation_mm = {160, 0, 125};  // the border is at 160
  const PartTruth truth = scanBin(scene.meshes, scene.parts, kBin, scanner).truth[0];
  EXPECT_GT(truth.all_box.x1, 320 + 20);
  EXPECT_EQ(truth.visible_box.x1, 320);
  EXPECT_NEAR(truth.visible_fraction, 0.5, 0.03);
  EXPECT_LT(truth.measured_px, truth.all_px);
}

TEST(BinScanTest, ANearCameraIsAllowedOnlyOutsideOfTheParts) {
  Scene scene;
  scene.parts[0].world_from_object.translation_mm.z = 60.0;
  ScannerOptions scanner = options("none");
  scanner.distance_mm = 30.0;
  EXPECT_THROW(scanBin(scene.meshes, scene.parts, kBin, scanner), Error);
  EXPECT_THROW(binMesh(BinShape{{0.0, 10.0, 10.0}}), Error);
}

}  // namespace
}  // namespace rangepose
