#include "sim/scanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "sim_meshes.h"

namespace rangepose {
namespace {

ScannerOptions smallScanner(const std::string& sensor) {
  ScannerOptions options;
  options.width = 160;
  options.height = 120;
  options.distance_mm = 700.0;
  options.sensor = sensorModel(sensor);
  return options;
}

PlacedPart placedAt(int mesh, const glm::dvec3& position_mm) {
  return {mesh, {glm::dmat3(1.0), position_mm}};
}

/// A plate with a smaller block on its middle, seen from straight above.
struct Stack {
  std::vector<Mesh> meshes = {boxMesh({-60, -60, 0}, {60, 60, 10}),
                              boxMesh({-20, -20, 0}, {20, 20, 40})};
  std::vector<PlacedPart> heap = {placedAt(0, {0, 0, 0}), placedAt(1, {0, 0, 10})};
};

int lostPixels(const Scan& scan) {
  return static_cast<int>(std::count(scan.image.depth_mm.begin(), scan.image.depth_mm.end(), 0.0f));
}

TEST(ScannerTest, WithoutNoiseItIsTheCleanRender) {
  const Stack stack;
  const ScannerOptions options = smallScanner("none");
  const Scan scan = scanHeap(stack.meshes, stack.heap, options);
  const CleanView clean = renderHeap(
      stack.meshes, stack.heap, scannerCamera(options), scannerPose(stack.heap, options));
  ASSERT_EQ(scan.image.depth_mm.width(), 160);
  ASSERT_EQ(scan.image.depth_mm.height(), 120);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      ASSERT_FLOAT_EQ(scan.image.depth_mm.at(u, v), clean.surface.at(u, v).w) << u << " " << v;
    }
  }
}

TEST(ScannerTest, DepthOfTableAndPartsIsExact) {
  const Stack stack;
  ScannerOptions options = smallScanner("none");
  options.tilt_rad = 0.0;
  const Scan scan = scanHeap(stack.meshes, stack.heap, options);
  // The camera looks at the mean of the parts' origins, (0, 0, 5), from 700 mm above.
  EXPECT_NEAR(scan.image.depth_mm.at(80, 60), 705.0 - 50.0, 1e-3);
  EXPECT_NEAR(scan.image.depth_mm.at(80 + 8, 60), 705.0 - 10.0, 1e-3);
  EXPECT_NEAR(scan.image.depth_mm.at(2, 2), 705.0, 1e-3);
}

TEST(ScannerTest, TruthProjectsOntoWhatIsSeen) {
  const Stack stack;
  const ScannerOptions options = smallScanner("none");
  const Scan scan = scanHeap(stack.meshes, stack.heap, options);
  // The middle of the block's top face, by the true pose.
  const glm::dvec3 top = scan.truth[1].camera_from_object * glm::dvec3(0, 0, 40);
  const glm::dvec2 pixel = scan.image.camera.project(top);
  const float depth = scan.image.depth_mm.at(static_cast<int>(std::lround(pixel.x)),
                                             static_cast<int>(std::lround(pixel.y)));
  EXPECT_NEAR(depth, top.z, 3.0);
}

TEST(ScannerTest, VisibleFractionCountsWhatIsHidden) {
  const Stack stack;
  ScannerOptions options = smallScanner("none");
  options.tilt_rad = 0.0;
  options.distance_mm = 2000.0;
  options.focal_px = 1200.0;
  const Scan scan = scanHeap(stack.meshes, stack.heap, options);
  EXPECT_EQ(scan.truth[1].visible_fraction, 1.0);
  // The block hides 40x40 of 120x120 mm, a little more as it stands nearer.
  EXPECT_NEAR(scan.truth[0].visible_fraction, 1.0 - 1600.0 / 14400.0, 0.02);
}

TEST(ScannerTest, PartCutByTheBorderIsPartlyVisible) {
  const std::vector<Mesh> meshes = {boxMesh({-20, -20, 0}, {20, 20, 1})};
  const std::vector<PlacedPart> heap = {placedAt(0, {-200, 0, 0}), placedAt(0, {200, 0, 0})};
  ScannerOptions options = smallScanner("none");
  options.tilt_rad = 0.0;
  options.focal_px = 79.5 * 700.0 / 200.0;  // 200 mm aside is the last column
  const Scan scan = scanHeap(meshes, heap, options);
  EXPECT_NEAR(scan.truth[0].visible_fraction, 0.5, 0.06);
  EXPECT_NEAR(scan.truth[1].visible_fraction, 0.5, 0.06);
}

TEST(ScannerTest, FractionsOfAHeapAreFractions) {
  HeapOptions heap_options;
  heap_options.count = 6;
  heap_options.nudges = 30;
  heap_options.radius_mm = 30.0;
  const std::vector<Mesh> meshes = {angleMesh()};
  const std::vector<PlacedPart> heap = makeHeap(meshes, heap_options);
  const Scan scan = scanHeap(meshes, heap, smallScanner("structured-light"));
  ASSERT_EQ(scan.truth.size(), 6u);
  double lowest = 1.0;
  for (const PartTruth& part : scan.truth) {
    EXPECT_GE(part.visible_fraction, 0.0);
    EXPECT_LE(part.visible_fraction, 1.0);
    lowest = std::min(lowest, part.visible_fraction);
  }
  EXPECT_LT(lowest, 1.0) << "nothing hides anything: not a heap";
}

TEST(ScannerTest, SameSeedSameImage) {
  const Stack stack;
  ScannerOptions options = smallScanner("rough");
  const Scan first = scanHeap(stack.meshes, stack.heap, options);
  EXPECT_EQ(first.image.depth_mm, scanHeap(stack.meshes, stack.heap, options).image.depth_mm);
  options.seed = 2;
  EXPECT_NE(first.image.depth_mm, scanHeap(stack.meshes, stack.heap, options).image.depth_mm);
}

TEST(ScannerTest, NoiseGrowsWithItsLevelAndStaysSmall) {
  const Stack stack;
  const Scan clean = scanHeap(stack.meshes, stack.heap, smallScanner("none"));
  std::vector<double> deviation_mm;
  std::vector<int> lost;
  for (const std::string sensor : {"structured-light", "rough"}) {
    const Scan noisy = scanHeap(stack.meshes, stack.heap, smallScanner(sensor));
    double sum_sq = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < noisy.image.depth_mm.size(); ++i) {
      const float measured = noisy.image.depth_mm.data()[i];
      if (measured == 0.0f) continue;
      const double error = measured - clean.image.depth_mm.data()[i];
      if (std::abs(error) > 5.0) continue;  // mixed with the far side of an edge
      sum_sq += error * error;
      ++count;
    }
    deviation_mm.push_back(std::sqrt(sum_sq / count));
    lost.push_back(lostPixels(noisy));
  }
  EXPECT_EQ(lostPixels(clean), 0);
  EXPECT_GT(lost[0], 0);
  EXPECT_GT(lost[1], lost[0]);
  EXPECT_NEAR(deviation_mm[0], 0.16, 0.05);
  EXPECT_NEAR(deviation_mm[1], 0.55, 0.2);
}

TEST(ScannerTest, MeasuredDepthIsInWholeSteps) {
  const Stack stack;
  const Scan scan = scanHeap(stack.meshes, stack.heap, smallScanner("structured-light"));
  for (const float depth : scan.image.depth_mm) {
    const double steps = depth / scan.image.camera.depth_scale;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
  }
}

TEST(ScannerTest, BlockShadowsTheTableOnTheFarSideOfTheProjector) {
  const std::vector<Mesh> meshes = {boxMesh({-20, -20, 0}, {20, 20, 120})};
  const std::vector<PlacedPart> heap = {placedAt(0, {0, 0, 0})};
  ScannerOptions options = smallScanner("structured-light");
  options.width = 320;
  options.tilt_rad = 0.0;
  const Scan scan = scanHeap(meshes, heap, options);
  // Light from 75 mm to the right and 700 mm up passes the left edge of the top, 120 mm up, and
  // meets the table 20 mm further left; of these the block itself hides the first 4 from the
  // camera.
  const auto lostIn = [&](int x0_mm, int x1_mm) {
    int lost = 0;
    for (int x = x0_mm; x <= x1_mm; ++x) {
      const glm::dvec2 pixel = scan.image.camera.project({x, 0.0, 700.0});
      lost += scan.image.depth_mm.at(static_cast<int>(std::lround(pixel.x)), 60) == 0.0f ? 1 : 0;
    }
    return lost;
  };
  EXPECT_GE(lostIn(-34, -28), 6);
  EXPECT_EQ(lostIn(28, 34), 0);
  EXPECT_EQ(lostIn(-52, -46), 0);
}

TEST(ScannerTest, CameraWithinTheHeapIsRefused) {
  const Stack stack;
  ScannerOptions options = smallScanner("none");
  options.distance_mm = 60.0;
  EXPECT_THROW(scanHeap(stack.meshes, stack.heap, options), Error);
}

TEST(ScannerTest, BadOptionsAreRefused) {
  const Stack stack;
  ScannerOptions options = smallScanner("structured-light");
  options.width = 4;
  EXPECT_THROW(scanHeap(stack.meshes, stack.heap, options), Error);
  EXPECT_THROW(scanHeap(stack.meshes, {}, smallScanner("structured-light")), Error);
}

}  // namespace
}  // namespace rangepose
