// What bins look like to the sensors that users have. If these fail, parts are tuned and measured
// on images that no such sensor takes.
#include "sim/sensor_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/scanner.h"
#include "sim_meshes.h"

namespace rangepose {
namespace {

using testing::HasSubstr;

constexpr double kBlockMm = 60.0;   // height of the block over the table
constexpr double kTableMm = 560.0;  // from the camera

#ifdef RP_WITHOUT_MATCHING
const std::vector<std::string> kKinds = {"structured-light", "rough", "tof", "laser"};
#else
const std::vector<std::string> kKinds = {
    "structured-light", "rough", "stereo", "speckle", "tof", "laser"};
#endif

PlacedPart at(int mesh, const glm::dvec3& position_mm) {
  return {mesh, {glm::dmat3(1.0), position_mm}};
}

/// A block 80 mm wide on a table, its middle at x = block_mm, from straight above x = 0.
Scan blockSeenBy(const std::string& sensor,
                 std::uint64_t seed = 1,
                 double block_mm = 0.0,
                 double depth_scale = 0.0) {
  const std::vector<Mesh> meshes = {boxMesh({-40, -40, 0}, {40, 40, kBlockMm})};
  ScannerOptions options;
  options.sensor = sensorModel(sensor);
  options.seed = seed;
  options.depth_scale = depth_scale;
  const glm::dmat3 down(
      glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.0, 0.0, -1.0));
  return scanFrom(meshes, {at(0, {block_mm, 0, 0})}, {down, {0.0, 0.0, kTableMm}}, options);
}

struct Errors {
  int pixels = 0;
  int lost = 0;
  double mean_mm = 0.0;
  double rms_mm = 0.0;
};

/// On the block's top, `inset_mm` inside of its edges.
Errors errorsOnTop(const Scan& scan, double inset_mm) {
  const Camera& camera = scan.image.camera;
  const double top_mm = kTableMm - kBlockMm;
  Errors errors;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const glm::dvec3 p = camera.unproject(u, v, top_mm);
      if (std::abs(p.x) > 40.0 - inset_mm || std::abs(p.y) > 40.0 - inset_mm) continue;
      ++errors.pixels;
      const float z = scan.image.depth_mm.at(u, v);
      errors.lost += z == 0.0f ? 1 : 0;
      if (z == 0.0f) continue;
      errors.mean_mm += z - top_mm;
      errors.rms_mm += (z - top_mm) * (z - top_mm);
    }
  }
  const int measured = errors.pixels - errors.lost;
  errors.mean_mm /= measured;
  errors.rms_mm = std::sqrt(errors.rms_mm / measured);
  return errors;
}

/// Pixels without depth on the table right beside the block's side at x = +-40 mm, in rows of its
/// middle; 0..1.
double lostBeside(const Scan& scan, double from_mm, double to_mm) {
  const Camera& camera = scan.image.camera;
  int lost = 0;
  int pixels = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const glm::dvec3 p = camera.unproject(u, v, kTableMm);
      if (p.x < from_mm || p.x > to_mm || std::abs(p.y) > 20.0) continue;
      ++pixels;
      lost += scan.image.depth_mm.at(u, v) == 0.0f ? 1 : 0;
    }
  }
  return static_cast<double>(lost) / pixels;
}

class EverySensor : public testing::TestWithParam<std::string> {};

TEST_P(EverySensor, MeasuresAFaceThatLooksAtIt) {
  const Errors errors = errorsOnTop(blockSeenBy(GetParam()), 12.0);
  ASSERT_GT(errors.pixels, 1000);
  EXPECT_LT(errors.lost, errors.pixels / 6);
  EXPECT_LT(std::abs(errors.mean_mm), 2.0);
  EXPECT_LT(errors.rms_mm, 2.5);
}

TEST_P(EverySensor, SameSeedSameImageOnAnyNumberOfThreads) {
  setThreadCount(1);
  const Scan alone = blockSeenBy(GetParam(), 3);
  setThreadCount(0);
  EXPECT_EQ(alone.image.depth_mm, blockSeenBy(GetParam(), 3).image.depth_mm);
  EXPECT_NE(alone.image.depth_mm, blockSeenBy(GetParam(), 4).image.depth_mm);
}

TEST_P(EverySensor, DepthIsInWholeSteps) {
  const Scan scan = blockSeenBy(GetParam());
  for (const float z : scan.image.depth_mm) {
    const double steps = z / scan.image.camera.depth_scale;
    ASSERT_NEAR(steps, std::round(steps), 1e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EverySensor, testing::ValuesIn(kKinds), [](const auto& kind) {
  std::string name = kind.param;
  std::erase(name, '-');
  return name;
});

TEST(SensorModelTest, UnknownNameListsTheKnownOnes) {
  try {
    sensorModel("eye");
    FAIL() << "accepted";
  } catch (const Error& error) {
    for (const std::string& name : sensorNames()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

TEST(SensorModelTest, EveryNameHasAModelAndASummary) {
  for (const std::string& name : sensorNames()) {
    EXPECT_EQ(sensorModel(name).name, name);
    EXPECT_FALSE(sensorSummary(name).empty()) << name;
  }
}

TEST(SensorModelTest, PhaseNeedsAPinholeCamera) {
  ScannerOptions options;
  options.sensor = sensorModel("tof");
  options.orthographic = true;
  const std::vector<Mesh> meshes = {boxMesh({-40, -40, 0}, {40, 40, kBlockMm})};
  EXPECT_THROW(scanHeap(meshes, {at(0, {0, 0, 0})}, options), Error);
}

// The band beside a part in which one of the two cameras, or the projector, sees nothing.
#ifndef RP_WITHOUT_MATCHING
TEST(SensorModelTest, MatchingLosesTheTableOnTheFarSideOfItsSecondView) {
  for (const std::string sensor : {"stereo", "speckle"}) {
    const Scan scan = blockSeenBy(sensor);
    const double baseline_mm = sensorModel(sensor).baseline_mm;
    // From there a ray over the block's left edge meets the table this much farther left.
    const double hidden_mm = kBlockMm * (baseline_mm + 40.0) / (kTableMm - kBlockMm);
    const double seen_mm = kBlockMm * 40.0 / (kTableMm - kBlockMm);
    // Stereo closes a part of it by its windows and its smoothing.
    EXPECT_GT(lostBeside(scan, -40.0 - hidden_mm + 1.0, -40.0 - seen_mm - 1.0), 0.4) << sensor;
    EXPECT_LT(lostBeside(scan, 40.0 + seen_mm + 1.0, 40.0 + hidden_mm - 1.0), 0.35) << sensor;
    EXPECT_LT(lostBeside(scan, -40.0 - hidden_mm - 60.0, -40.0 - hidden_mm - 20.0), 0.35) << sensor;
  }
}

// Else edges are as sharp as a structured-light scanner's, and what depends on their width is
// tuned for that.
TEST(SensorModelTest, StereoSmearsEdges) {
  const auto steps = [](const std::string& sensor) {
    const Scan scan = blockSeenBy(sensor);
    const double low_mm = kTableMm - 0.85 * kBlockMm;
    const double high_mm = kTableMm - 0.15 * kBlockMm;
    int between = 0;
    for (const float z : scan.image.depth_mm) between += z > low_mm && z < high_mm ? 1 : 0;
    // Per pixel of the block's outline.
    return between / (4.0 * 80.0 * scan.image.camera.fx / (kTableMm - kBlockMm));
  };
  EXPECT_GT(steps("stereo"), 0.8);
  EXPECT_LT(steps("structured-light"), 0.3);
}

TEST(SensorModelTest, SpeckleDepthHasTheStepsOfItsDisparity) {
  const Scan scan = blockSeenBy("speckle", 1, 0.0, 0.001);
  const SensorModel sensor = sensorModel("speckle");
  const double per_px = sensor.fx * sensor.baseline_mm;
  int measured = 0;
  for (const float z : scan.image.depth_mm) {
    if (z == 0.0f) continue;
    ++measured;
    const double nearest = std::round(per_px / z / 0.125) * 0.125;
    ASSERT_NEAR(z, per_px / nearest, 0.002);
  }
  EXPECT_GT(measured, 100000);
}

// Users crop and bin their images: the same scene in half as many pixels.
TEST(SensorModelTest, MatchingSensorsMeasureInImagesOfOtherSizes) {
  for (const std::string sensor : {"stereo", "speckle"}) {
    const std::vector<Mesh> meshes = {boxMesh({-40, -40, 0}, {40, 40, kBlockMm})};
    ScannerOptions options;
    options.sensor = sensorModel(sensor);
    options.width = options.sensor.width / 2;
    options.height = options.sensor.height / 2;
    const glm::dmat3 down(
        glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.0, 0.0, -1.0));
    const Scan scan = scanFrom(meshes, {at(0, {0, 0, 0})}, {down, {0.0, 0.0, kTableMm}}, options);
    const Errors errors = errorsOnTop(scan, 15.0);
    EXPECT_LT(errors.lost, errors.pixels / 3) << sensor;
    EXPECT_LT(std::abs(errors.mean_mm), 4.0) << sensor;
  }
}
#endif

TEST(SensorModelTest, PixelsOfATimeOfFlightCameraFlyAtJumps) {
  const Scan scan = blockSeenBy("tof");
  const auto between = [](const Scan& of) {
    int count = 0;
    for (const float z : of.image.depth_mm) {
      count += z > kTableMm - 0.8 * kBlockMm && z < kTableMm - 0.2 * kBlockMm ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(between(scan), 100);
  EXPECT_EQ(between(blockSeenBy("none")), 0);
}

// Light that goes from one wall to the other before it comes back has a longer way.
TEST(SensorModelTest, CornersSeemDeeperToATimeOfFlightCamera) {
  const auto besideBlock = [](double block_mm) {
    double sum = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Scan scan = blockSeenBy("tof", seed, block_mm);
      const Camera& camera = scan.image.camera;
      for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
          const glm::dvec3 p = camera.unproject(u, v, kTableMm);
          if (std::abs(p.x - 180.0) > 4.0 || std::abs(p.y) > 20.0) continue;
          sum += scan.image.depth_mm.at(u, v);
          ++count;
        }
      }
    }
    return sum / count;
  };
  // Before a wall that faces the camera, and far from it.
  EXPECT_GT(besideBlock(240.0), besideBlock(-200.0) + 0.3);
}

// Its light comes from +y, so that the block's shadow lies at -y.
TEST(SensorModelTest, ALaserHasLongPixelsAndShadowsAlongY) {
  const Scan scan = blockSeenBy("laser");
  const Camera& camera = scan.image.camera;
  EXPECT_NEAR(camera.fx / camera.fy, 2.0, 1e-12);
  const auto lostIn = [&](double from_mm, double to_mm) {
    int lost = 0;
    int pixels = 0;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const glm::dvec3 p = camera.unproject(u, v, kTableMm);
        if (p.y < from_mm || p.y > to_mm || std::abs(p.x) > 20.0) continue;
        ++pixels;
        lost += scan.image.depth_mm.at(u, v) == 0.0f ? 1 : 0;
      }
    }
    return static_cast<double>(lost) / pixels;
  };
  // A ray over the block's edge at y = -40 mm meets the table this much farther on.
  const double hidden_mm = kBlockMm * (sensorModel("laser").baseline_mm + 40.0) / 500.0;
  EXPECT_GT(lostIn(-40.0 - hidden_mm + 2.0, -47.0), 0.9);
  EXPECT_LT(lostIn(-40.0 - hidden_mm - 30.0, -40.0 - hidden_mm - 5.0), 0.1);
  EXPECT_LT(lostIn(48.0, 70.0), 0.1);
}

TEST(SensorModelTest, AllOfABinIsInTheImageOfALaser) {
  const BinShape bin{{300.0, 200.0, 100.0}};
  ScannerOptions options;
  options.sensor = sensorModel("laser");
  options.distance_mm = distanceFor(bin, options);
  const Camera camera = scannerCamera(options);
  const Scan scan = scanBin({boxMesh({-5, -5, 0}, {5, 5, 5})}, {at(0, {0, 0, 0})}, bin, options);
  for (const glm::vec3& vertex : binMesh(bin).vertices) {
    const glm::dvec2 pixel = camera.project(scan.camera_from_world * glm::dvec3(vertex));
    EXPECT_TRUE(pixel.x > 0.0 && pixel.x < camera.width - 1.0) << pixel.x;
    EXPECT_TRUE(pixel.y > 0.0 && pixel.y < camera.height - 1.0) << pixel.y;
  }
}

// A shiny face sends no light back to any of them.
TEST(SensorModelTest, ShinyFacesAreLost) {
  const std::vector<Mesh> meshes = {boxMesh({-40, -40, 0}, {40, 40, kBlockMm})};
  Mesh top = meshes.front();
  std::erase_if(top.triangles, [&](const glm::uvec3& triangle) {
    return top.vertices[triangle.x].z + top.vertices[triangle.y].z + top.vertices[triangle.z].z <
           3.0 * kBlockMm - 1.0;
  });
  ASSERT_EQ(top.triangles.size(), 2U);
  const glm::dmat3 down(
      glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.0, 0.0, -1.0));
  for (const std::string& sensor : kKinds) {
    ScannerOptions options;
    options.sensor = sensorModel(sensor);
    const Scan scan =
        scanFrom(meshes, {at(0, {0, 0, 0})}, {down, {0.0, 0.0, kTableMm}}, options, {}, {top});
    const Errors errors = errorsOnTop(scan, 8.0);
    EXPECT_GT(errors.lost, 0.8 * errors.pixels) << sensor;
  }
}

}  // namespace
}  // namespace rangepose
