// Camera models: an error here scales or shifts every reported position.
#include "core/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "support/range_scenes.h"

namespace rangepose {
namespace {

using testing::HasSubstr;

Camera pinhole() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 571.3;
  camera.fy = 568.9;
  camera.cx = 318.25;
  camera.cy = 241.5;
  return camera;
}

Camera parallel() {
  Camera camera = pinhole();
  camera.fx = 0.0;
  camera.fy = 0.0;
  camera.orthographic = true;
  camera.pixel_size_mm = 0.37;
  return camera;
}

TEST(CameraTest, ProjectUndoesUnproject) {
  test::Random random(1);
  for (const Camera& camera : {pinhole(), parallel()}) {
    for (int i = 0; i < 200; ++i) {
      const double u = random.uniform(-10, 650);
      const double v = random.uniform(-10, 490);
      const double z = random.uniform(100, 3000);
      const glm::dvec3 point = camera.unproject(u, v, z);
      EXPECT_DOUBLE_EQ(point.z, z) << "depth runs along z, not along the ray";
      EXPECT_NEAR(camera.project(point).x, u, 1e-9);
      EXPECT_NEAR(camera.project(point).y, v, 1e-9);
    }
  }
}

TEST(CameraTest, PinholeFollowsTheCameraMatrix) {
  const Camera camera = pinhole();
  // One focal length to the right of the axis at unit depth; y grows downwards.
  const glm::dvec2 pixel = camera.project({1000.0, -500.0, 1000.0});
  EXPECT_DOUBLE_EQ(pixel.x, camera.cx + camera.fx);
  EXPECT_DOUBLE_EQ(pixel.y, camera.cy - 0.5 * camera.fy);
  EXPECT_DOUBLE_EQ(camera.pixelSpacingMm(571.3), 1.0);
  EXPECT_DOUBLE_EQ(parallel().pixelSpacingMm(571.3), 0.37);
}

TEST(CameraTest, ViewingRayPointsFromTheCameraThroughThePoint) {
  const glm::dvec3 point(300.0, -400.0, 1200.0);
  EXPECT_LT(glm::distance(pinhole().viewingRay(point), point / 1300.0), 1e-12);
  EXPECT_EQ(parallel().viewingRay(point), glm::dvec3(0.0, 0.0, 1.0));
}

TEST(CameraTest, OrthoPixelsAndPointsRoundTrip) {
  OrthoCamera camera;
  camera.width = 128;
  camera.height = 101;
  camera.pixel_mm = 0.8;
  test::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 pixel(random.uniform(0, 128), random.uniform(0, 101), random.uniform(10, 500));
    const glm::dvec3 back = camera.pixelFromOrtho(camera.orthoFromPixel(pixel.x, pixel.y, pixel.z));
    EXPECT_LT(glm::distance(back, pixel), 1e-9);
  }
  // Between the two middle columns of an even width, on the middle row of an odd height.
  EXPECT_EQ(camera.pixelFromOrtho(glm::dvec3(0.0)), glm::dvec3(63.5, 50.0, 0.0));
  const glm::dvec3 step = camera.orthoFromPixel(1, 0, 1) - camera.orthoFromPixel(0, 0, 0);
  EXPECT_LT(glm::distance(step, glm::dvec3(0.8, 0.0, 0.8)), 1e-12) << "x and z share one unit";
}

struct BadField {
  std::string named;  ///< must appear in the message
  bool orthographic;
  std::function<void(Camera&)> spoil;
};

TEST(CameraTest, CheckNamesTheBadField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(pinhole().check());
  EXPECT_NO_THROW(parallel().check());
  const std::vector<BadField> fields = {
      {"width", false, [](Camera& c) { c.width = 0; }},
      {"height", false, [](Camera& c) { c.height = -3; }},
      {"cam_K", false, [](Camera& c) { c.fx = 0.0; }},
      {"cam_K", false, [](Camera& c) { c.fy = -500.0; }},
      {"cam_K", false, [=](Camera& c) { c.fx = nan; }},
      {"cam_K", false, [=](Camera& c) { c.fy = inf; }},
      {"cam_K", false, [=](Camera& c) { c.cx = nan; }},
      {"cam_K", true, [=](Camera& c) { c.cy = inf; }},
      {"depth_scale", false, [](Camera& c) { c.depth_scale = 0.0; }},
      {"depth_scale", true, [=](Camera& c) { c.depth_scale = nan; }},
      {"pixel_size", true, [](Camera& c) { c.pixel_size_mm = 0.0; }},
      {"pixel_size", true, [=](Camera& c) { c.pixel_size_mm = nan; }},
  };
  for (const BadField& field : fields) {
    Camera camera = field.orthographic ? parallel() : pinhole();
    field.spoil(camera);
    try {
      camera.check();
      ADD_FAILURE() << "a bad " << field.named << " was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(field.named));
    }
  }
}

}  // namespace
}  // namespace rangepose
