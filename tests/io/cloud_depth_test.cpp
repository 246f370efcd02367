#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/camera_file.h"
#include "io/cloud_file.h"
#include "io/depth_file.h"
#include "io/io_support.h"

namespace rangepose {
namespace {

using test::errorOf;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Camera pinhole(int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = 110.0;
  camera.fy = 105.0;
  camera.cx = 0.47 * width;
  camera.cy = 0.55 * height;
  return camera;
}

/// A tilted plane with a step, seen by a camera; every seventh pixel has no measurement.
DepthImage scene(const Camera& camera) {
  DepthImage image{camera, Image<float>(camera.width, camera.height)};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if ((u + 3 * v) % 7 == 0) continue;
      image.depth_mm.at(u, v) = 600.0f + 2.0f * static_cast<float>(u) + (v > 20 ? -80.0f : 0.0f);
    }
  }
  return image;
}

PointCloud cloudOf(const DepthImage& image, bool organised) {
  PointCloud cloud;
  for (int v = 0; v < image.depth_mm.height(); ++v) {
    for (int u = 0; u < image.depth_mm.width(); ++u) {
      const float z = image.depth_mm.at(u, v);
      if (z > 0.0f) {
        cloud.points_mm.emplace_back(image.camera.unproject(u, v, z));
      } else if (organised) {
        cloud.points_mm.emplace_back(kNan);
      }
    }
  }
  cloud.width = organised ? image.depth_mm.width() : static_cast<int>(cloud.points_mm.size());
  cloud.height = organised ? image.depth_mm.height() : 1;
  return cloud;
}

PointCloud unorganised(std::vector<glm::vec3> points) {
  const int count = static_cast<int>(points.size());
  return {std::move(points), count, 1};
}

TEST(CloudDepth, ProjectionByTheCameraGivesTheImageBack) {
  const DepthImage image = scene(pinhole(64, 48));
  for (const bool organised : {false, true}) {
    EXPECT_EQ(depthFromCloud(cloudOf(image, organised), image.camera).depth_mm, image.depth_mm);
  }
}

TEST(CloudDepth, NearestPointWinsAndBadPointsAreDropped) {
  const Camera camera = pinhole(64, 48);
  const auto at = [&](double u, double v, double z) {
    return glm::vec3(camera.unproject(u, v, z));
  };
  const DepthImage image =
      depthFromCloud(unorganised({at(5, 6, 500),
                                  at(5.4, 5.6, 300),
                                  at(5, 6, 400),
                                  at(7, 7, -100),
                                  at(64, 10, 100),
                                  at(-1, 10, 100),
                                  {kNan, 0, 100},
                                  {1, 1, std::numeric_limits<float>::infinity()},
                                  {0, 0, 0}}),
                     camera);
  EXPECT_EQ(validPixels(image), 1);
  EXPECT_EQ(image.depth_mm.at(5, 6), 300.0f);
}

TEST(CloudDepth, OrthographicCameraProjectsAlongZ) {
  Camera camera =
      parseCamera(R"({"orthographic": true, "pixel_size": 2, "width": 11, "height": 9})", "c");
  const DepthImage image = depthFromCloud(unorganised({{4, -6, 70}, {4, -6, 60}}), camera);
  EXPECT_EQ(image.depth_mm.at(7, 1), 60.0f);
}

TEST(CloudDepth, CameraWithoutASizeTakesTheGrid) {
  const DepthImage image = scene(pinhole(64, 48));
  Camera camera = image.camera;
  camera.width = camera.height = 0;
  EXPECT_EQ(depthFromCloud(cloudOf(image, true), camera).depth_mm, image.depth_mm);
  EXPECT_THAT(errorOf([&] { depthFromCloud(cloudOf(image, false), camera); }),
              HasSubstr("\"width\" and \"height\" are needed"));
}

TEST(CloudDepth, CameraIsFittedToTheGrid) {
  const DepthImage image = scene(pinhole(64, 48));
  const DepthImage fitted = depthFromCloud(cloudOf(image, true), std::nullopt);
  EXPECT_EQ(fitted.depth_mm, image.depth_mm);
  EXPECT_NEAR(fitted.camera.fx, image.camera.fx, 1e-3);
  EXPECT_NEAR(fitted.camera.fy, image.camera.fy, 1e-3);
  EXPECT_NEAR(fitted.camera.cx, image.camera.cx, 1e-3);
  EXPECT_NEAR(fitted.camera.cy, image.camera.cy, 1e-3);
}

TEST(CloudDepth, GridThatNoPinholeMadeIsTakenAsUnorganised) {
  // Parallel rays onto a staircase: the same x at quite different z.
  PointCloud cloud;
  cloud.width = 60;
  cloud.height = 40;
  for (int v = 0; v < 40; ++v) {
    for (int u = 0; u < 60; ++u) {
      const float z = (u / 10 + v / 10) % 2 == 0 ? 300.0f : 900.0f;
      cloud.points_mm.emplace_back(
          4.0f * static_cast<float>(u - 30), 4.0f * static_cast<float>(v - 20), z);
    }
  }
  const DepthImage image = depthFromCloud(cloud, std::nullopt);
  EXPECT_NE(image.depth_mm.width(), 60);
  EXPECT_GT(validPixels(image), 600);
}

/// Each point of the cloud must be where the image says, within the width of a pixel.
void expectHoldsAllPoints(const DepthImage& image, const PointCloud& cloud) {
  for (const glm::vec3& point : cloud.points_mm) {
    const glm::dvec2 pixel = image.camera.project(point);
    const int u = static_cast<int>(std::floor(pixel.x + 0.5));
    const int v = static_cast<int>(std::floor(pixel.y + 0.5));
    ASSERT_TRUE(image.depth_mm.contains(u, v)) << pixel.x << " " << pixel.y;
    ASSERT_GT(image.depth_mm.at(u, v), 0.0f);
    ASSERT_LE(image.depth_mm.at(u, v), point.z);
  }
}

TEST(CloudDepth, MadeUpCameraHasTheStepOfARegularScan) {
  Camera camera = pinhole(300, 200);
  camera.fy = camera.fx;
  const PointCloud cloud = cloudOf(scene(camera), false);
  const DepthImage image = depthFromCloud(cloud, std::nullopt);
  EXPECT_NEAR(image.camera.fx, camera.fx, 0.01 * camera.fx);
  EXPECT_EQ(image.camera.fx, image.camera.fy);
  expectHoldsAllPoints(image, cloud);
  EXPECT_GT(validPixels(image),
            static_cast<int>(0.97 * static_cast<double>(cloud.points_mm.size())));
}

TEST(CloudDepth, MadeUpCameraHasAboutOnePointAPixelForAScatteredScan) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> side(-100.0f, 100.0f);
  std::vector<glm::vec3> points;
  points.reserve(20000);
  for (int i = 0; i < 20000; ++i) points.emplace_back(side(random), side(random), 500.0f);
  const PointCloud cloud = unorganised(std::move(points));
  const DepthImage image = depthFromCloud(cloud, std::nullopt);
  expectHoldsAllPoints(image, cloud);
  const double per_pixel = 20000.0 / static_cast<double>(image.depth_mm.size());
  EXPECT_GT(per_pixel, 0.5);
  EXPECT_LT(per_pixel, 2.0);
}

TEST(CloudDepth, MadeUpCameraStaysSmallWithAStrayPoint) {
  Camera camera = pinhole(200, 150);
  PointCloud cloud = cloudOf(scene(camera), false);
  cloud.points_mm.emplace_back(2000.0f, 0.0f, 500.0f);  // 76 degrees: kept
  cloud.points_mm.emplace_back(9000.0f, 0.0f, 500.0f);  // 87 degrees: dropped
  cloud.points_mm.emplace_back(0.0f, 0.0f, -500.0f);    // behind: dropped
  cloud = unorganised(cloud.points_mm);
  const DepthImage image = depthFromCloud(cloud, std::nullopt);
  EXPECT_LE(image.depth_mm.width(), 2048);
  EXPECT_NEAR(image.camera.fx, camera.fx, 0.05 * camera.fx);
}

TEST(CloudDepth, MadeUpCameraIsLimitedTo2048Pixels) {
  // Two dense patches far apart: their spacing alone would ask for more.
  std::vector<glm::vec3> points;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const float x = 0.01f * static_cast<float>(i);
      const float y = 0.01f * static_cast<float>(j);
      points.emplace_back(x - 300.0f, y, 500.0f);
      points.emplace_back(x + 300.0f, y, 500.0f);
    }
  }
  const PointCloud cloud = unorganised(std::move(points));
  const DepthImage image = depthFromCloud(cloud, std::nullopt);
  EXPECT_LE(image.depth_mm.width(), 2048);
  EXPECT_GE(image.depth_mm.width(), 2000);
  expectHoldsAllPoints(image, cloud);
}

TEST(CloudDepth, FewOrEqualPointsStillGiveAnImage) {
  for (const int count : {1, 3, 50}) {
    const PointCloud cloud =
        unorganised(std::vector<glm::vec3>(static_cast<std::size_t>(count), {1.0f, 2.0f, 300.0f}));
    const DepthImage image = depthFromCloud(cloud, std::nullopt);
    EXPECT_EQ(validPixels(image), 1);
    EXPECT_NO_THROW(image.camera.check());
  }
}

TEST(CloudDepth, NoPointInFrontIsAnError) {
  EXPECT_THAT(errorOf([] {
                depthFromCloud(unorganised({{0, 0, -5}, {kNan, 0, 0}}), std::nullopt);
              }),
              HasSubstr("no point lies in front of the camera"));
}

TEST(CloudDepth, CountThatDoesNotMatchTheSizeIsAnError) {
  EXPECT_THAT(errorOf([] {
                depthFromCloud({{{0, 0, 5}}, 2, 2}, std::nullopt);
              }),
              HasSubstr("1 points are not 2x2"));
}

}  // namespace
}  // namespace rangepose
