// The virtual cameras through which a scene is looked at.
#include "pipeline/scene_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "stages/foreground_host.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

constexpr int kWidthPx = 128;
constexpr double kPixelMm = 0.9;

Camera pinhole() { return test::pinholeCamera(640, 480, 420.0); }

Camera parallel() { return test::parallelCamera(640, 480, 0.8); }

/// Points all over what a sensor sees.
std::vector<glm::dvec3> pointsSeenBy(const Camera& sensor) {
  std::vector<glm::dvec3> points;
  for (const double u : {20.0, 320.0, 630.0}) {
    for (const double v : {15.0, 240.0, 470.0}) points.push_back(sensor.unproject(u, v, 550.0));
  }
  return points;
}

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance) {
  EXPECT_LT(glm::distance(actual, expected), tolerance)
      << "(" << actual.x << ", " << actual.y << ", " << actual.z << ") instead of (" << expected.x
      << ", " << expected.y << ", " << expected.z << ")";
}

class SensorTest : public testing::TestWithParam<bool> {
 protected:
  Camera sensor() const { return GetParam() ? parallel() : pinhole(); }
};

TEST_P(SensorTest, WindowLooksAlongTheRayAtThePoint) {
  for (const glm::dvec3& point : pointsSeenBy(sensor())) {
    const OrthoCamera window = windowCamera(sensor(), point, kWidthPx, kPixelMm);
    EXPECT_EQ(window.width, kWidthPx);
    EXPECT_EQ(window.height, kWidthPx);
    EXPECT_EQ(window.pixel_mm, kPixelMm);
    const glm::dmat3& axes = window.camera_from_ortho.rotation;
    const glm::dvec3 ray = GetParam() ? glm::dvec3(0.0, 0.0, 1.0) : glm::normalize(point);
    expectNear(axes[2], ray, 1e-12);
    expectNear(glm::cross(axes[0], axes[1]), axes[2], 1e-12);
    EXPECT_NEAR(glm::length(axes[0]), 1.0, 1e-12);
    EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-12);
    // Upright as the sensor is: x to the right, y down.
    EXPECT_GT(axes[0].x, 0.5);
    EXPECT_GT(axes[1].y, 0.5);
    const glm::dvec3 seen = window.pixelFromOrtho(window.camera_from_ortho.inverse() * point);
    EXPECT_NEAR(seen.x, 0.5 * kWidthPx - 0.5, 1e-9);
    EXPECT_NEAR(seen.y, 0.5 * kWidthPx - 0.5, 1e-9);
    EXPECT_GT(seen.z, 0.0);
  }
}

TEST_P(SensorTest, RegionHoldsThePointsOfTheWindow) {
  test::Random random(17);
  for (const glm::dvec3& point : pointsSeenBy(sensor())) {
    const OrthoCamera window = windowCamera(sensor(), point, kWidthPx, kPixelMm);
    const PixelBox region = windowRegion(sensor(), point, kWidthPx, kPixelMm);
    const double range = (window.camera_from_ortho.inverse() * point).z / kPixelMm;
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
      const double u = random.uniform(-0.5, kWidthPx - 0.5);
      const double v = random.uniform(-0.5, kWidthPx - 0.5);
      const double deep = random.uniform(-0.5, 0.5) * kWidthPx;
      const glm::dvec3 seen = window.camera_from_ortho * window.orthoFromPixel(u, v, range + deep);
      const glm::ivec2 pixel(glm::round(sensor().project(seen)));
      if (!Image<float>(640, 480).contains(pixel.x, pixel.y)) continue;
      ++inside;
      EXPECT_TRUE(pixel.x >= region.x0 && pixel.x < region.x1 && pixel.y >= region.y0 &&
                  pixel.y < region.y1)
          << pixel.x << ", " << pixel.y;
    }
    EXPECT_GT(inside, 50);
    EXPECT_TRUE(region.x0 >= 0 && region.y0 >= 0 && region.x1 <= 640 && region.y1 <= 480);
  }
}

TEST_P(SensorTest, SceneCameraCoversTheMask) {
  DepthImage image{sensor(), Image<float>(640, 480)};
  Image<std::uint8_t> mask(640, 480, 0);
  for (int v = 100; v < 300; ++v) {
    for (int u = 400; u < 630; ++u) {
      image.depth_mm.at(u, v) = static_cast<float>(500 + u - v);
      mask.at(u, v) = 1;
    }
  }
  for (const int max_px : {64, 200, 1024}) {
    const OrthoCamera camera = sceneCamera(host::extentOf(image, mask), 1.5, max_px);
    EXPECT_LE(camera.width, max_px);
    EXPECT_LE(camera.height, max_px);
    EXPECT_GE(camera.pixel_mm, 1.5);
    const Pose ortho_from_camera = camera.camera_from_ortho.inverse();
    double widest = 0.0;
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        if (mask.at(u, v) == 0) continue;
        const glm::dvec3 point = sensor().unproject(u, v, image.depth_mm.at(u, v));
        const glm::dvec3 pixel = camera.pixelFromOrtho(ortho_from_camera * point);
        ASSERT_TRUE(pixel.x >= 0.0 && pixel.x <= camera.width - 1.0) << pixel.x;
        ASSERT_TRUE(pixel.y >= 0.0 && pixel.y <= camera.height - 1.0) << pixel.y;
        ASSERT_GT(pixel.z, 0.0);
        widest = std::max(widest, std::max(pixel.x, pixel.y));
      }
    }
    // Not larger than it must be.
    EXPECT_GT(widest, std::max(camera.width, camera.height) - 8.0);
  }
  EXPECT_EQ(sceneCamera(host::extentOf(image, mask), 1.5, 1024).pixel_mm, 1.5);
}

TEST_P(SensorTest, SceneCameraOfAnEmptyMaskIsEmpty) {
  const DepthImage image{sensor(), Image<float>(640, 480, 500.0f)};
  EXPECT_EQ(sceneCamera(host::extentOf(image, Image<std::uint8_t>(640, 480, 0)), 1.0, 1024).width,
            0);
}

TEST_P(SensorTest, SceneCameraOfOnePixelShowsIt) {
  const DepthImage image{sensor(), Image<float>(640, 480, 500.0f)};
  Image<std::uint8_t> mask(640, 480, 0);
  mask.at(77, 401) = 1;
  const OrthoCamera camera = sceneCamera(host::extentOf(image, mask), 1.0, 1024);
  ASSERT_GT(camera.width, 0);
  const glm::dvec3 pixel = camera.pixelFromOrtho(camera.camera_from_ortho.inverse() *
                                                 image.camera.unproject(77, 401, 500.0));
  EXPECT_NEAR(pixel.x, 0.5 * camera.width - 0.5, 1e-9);
  EXPECT_NEAR(pixel.y, 0.5 * camera.height - 0.5, 1e-9);
}

/// An object of which one view is exactly how `window` sees `pose`.
ReferenceObject objectSeenBy(const OrthoCamera& window, const Pose& pose) {
  std::vector<glm::dmat3> rotations = uniformRotations(3);
  rotations.push_back(glm::transpose(window.camera_from_ortho.rotation) * pose.rotation);
  return describeObject(
      test::meshOf(test::bracketBoxes()), 1, 64, rotations, channelOptionsFor(64));
}

TEST_P(SensorTest, PoseOfAHypothesisIsThePoseItStandsFor) {
  for (const glm::dvec3& point : pointsSeenBy(sensor())) {
    const Pose pose{rotationFromVector({0.4, -1.3, 0.8}), point + glm::dvec3(9.0, -14.0, 6.0)};
    const OrthoCamera window = windowCamera(sensor(), point, kWidthPx, kPixelMm);
    const ReferenceObject object = objectSeenBy(window, pose);
    Hypothesis hypothesis;
    hypothesis.view = 3;
    hypothesis.translation_px =
        glm::vec3(window.camera_from_ortho.inverse() * (pose * object.center_mm) / kPixelMm);
    const Pose found = poseOf(hypothesis, object, window);
    EXPECT_LT(rotationAngleBetween(found.rotation, pose.rotation), 1e-6);
    expectNear(found.translation_mm, pose.translation_mm, 1e-3);
  }
}

/// A reference pixel (u, v, g) is laid on window pixel (u + margin + x, v + margin + y), range
/// g - size + z: the vertex it shows must be where the pose puts that vertex.
TEST_P(SensorTest, PoseOfAHypothesisPutsVerticesWhereTheReferenceLies) {
  const glm::dvec3 point = pointsSeenBy(sensor())[1];
  ReferenceObject object = describeObject(
      test::meshOf(test::bracketBoxes()), 1, 64, uniformRotations(5), channelOptionsFor(64));
  const OrthoCamera window = windowCamera(sensor(), point, 2 * object.size, object.pixel_mm);
  const double margin = 0.5 * (window.width - object.size);
  for (int view = 0; view < 5; ++view) {
    Hypothesis hypothesis;
    hypothesis.view = view;
    hypothesis.translation_px = {4.0f, -7.0f, 610.0f};
    const Pose found = poseOf(hypothesis, object, window);
    const Camera tile = tileCamera(object);
    const Pose tile_pose = tilePose(object, object.views[static_cast<std::size_t>(view)].rotation);
    for (const glm::vec3& vertex : object.mesh.vertices) {
      const glm::dvec3 in_tile = tile_pose * glm::dvec3(vertex);
      const glm::dvec2 uv = tile.project(in_tile);
      const glm::dvec3 laid =
          window.camera_from_ortho *
          window.orthoFromPixel(uv.x + margin + 4.0,
                                uv.y + margin - 7.0,
                                in_tile.z / object.pixel_mm - object.size + 610.0);
      expectNear(found * glm::dvec3(vertex), laid, 1e-4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors, SensorTest, testing::Bool(), [](const auto& made) {
  return made.param ? "parallel" : "pinhole";
});

TEST(WindowRegionTest, PointTooNearReadsTheWholeImage) {
  const PixelBox region = windowRegion(pinhole(), {0.0, 0.0, 30.0}, kWidthPx, kPixelMm);
  EXPECT_EQ(region, (PixelBox{0, 0, 640, 480}));
}

}  // namespace
}  // namespace rangepose
