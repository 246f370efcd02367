#include "peers/scene_cloud.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rangepose::peers {
namespace {

/// The plane dot(normal, p) = dot(normal, (0, 0, z_mm)), seen by a camera 64 x 48.
DepthImage planeImage(const glm::dvec3& normal, double z_mm, bool orthographic) {
  DepthImage image;
  image.camera = {64, 48, 80.0, 80.0, 31.5, 23.5, 1.0, orthographic, orthographic ? 2.0 : 0.0};
  image.depth_mm = Image<float>(64, 48, 0.0f);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      const glm::dvec3 at = image.camera.unproject(u, v, orthographic ? 0.0 : 1.0);
      const double offset = normal.z * z_mm;
      const double z = orthographic ? (offset - normal.x * at.x - normal.y * at.y) / normal.z
                                    : offset / glm::dot(normal, at);
      image.depth_mm.at(u, v) = static_cast<float>(z);
    }
  }
  return image;
}

class CloudTest : public ::testing::TestWithParam<bool> {};

TEST_P(CloudTest, NormalsOfAPlaneAreItsOwnAndLookAtTheCamera) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.4, -0.3, -1.0));
  const DepthImage image = planeImage(normal, 300.0, GetParam());
  const Cloud cloud = cloudOf(image, Image<std::uint8_t>(64, 48, 1), 3);
  ASSERT_GT(cloud.size(), 2000U);
  for (const SurfacePoint& point : cloud) {
    ASSERT_GT(glm::dot(glm::dvec3(point.normal), normal), 0.9999);
    ASSERT_NEAR(glm::dot(glm::dvec3(point.position_mm), normal), 300.0 * normal.z, 1e-3);
  }
}

TEST_P(CloudTest, WhatIsMaskedOrNotMeasuredGivesNoPoint) {
  DepthImage image = planeImage({0.0, 0.0, -1.0}, 300.0, GetParam());
  Image<std::uint8_t> keep(64, 48, 0);
  for (int v = 20; v < 24; ++v) {
    for (int u = 20; u < 30; ++u) keep.at(u, v) = 1;
  }
  image.depth_mm.at(22, 22) = 0.0f;
  EXPECT_EQ(cloudOf(image, keep, 2).size(), 39U);
}

INSTANTIATE_TEST_SUITE_P(Cameras, CloudTest, ::testing::Bool());

TEST(ThinnedTest, BothSidesOfAThinWallStayApart) {
  const SurfacePoint front{{1.0f, 1.0f, 1.0f}, {0.0f, 0.0f, -1.0f}};
  const SurfacePoint beside{{2.0f, 1.0f, 1.0f}, {0.0f, 0.0f, -1.0f}};
  const SurfacePoint back{{1.0f, 1.0f, 2.0f}, {0.0f, 0.0f, 1.0f}};
  const Cloud thin = thinned({front, beside, back}, 10.0);
  ASSERT_EQ(thin.size(), 2U);
  for (const SurfacePoint& point : thin) {
    EXPECT_FLOAT_EQ(std::abs(point.normal.z), 1.0f) << "a mean of both sides has no normal";
    EXPECT_FLOAT_EQ(point.position_mm.x, point.normal.z < 0.0f ? 1.5f : 1.0f);
  }
}

TEST(SeedsTest, AreApartAndLeaveNoPlaceOut) {
  Cloud cloud;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      cloud.push_back({{x, y, x == 30 && y == 20 ? 90.0f : 91.0f}, {0.0f, 0.0f, -1.0f}});
    }
  }
  const std::vector<glm::dvec3> seeds = spreadSeeds(cloud, 12.0, 1000);
  ASSERT_FALSE(seeds.empty());
  EXPECT_EQ(seeds.front(), glm::dvec3(30.0, 20.0, 90.0)) << "the one nearest to the camera";
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(glm::distance(seeds[i], seeds[j]), 12.0);
  }
  for (const SurfacePoint& point : cloud) {
    double nearest = 1e9;
    for (const glm::dvec3& seed : seeds)
      nearest = std::min(nearest, glm::distance(seed, glm::dvec3(point.position_mm)));
    ASSERT_LT(nearest, 12.0);
  }
  EXPECT_EQ(spreadSeeds(cloud, 12.0, 5).size(), 5U);
  EXPECT_TRUE(spreadSeeds({}, 12.0, 5).empty());
}

}  // namespace
}  // namespace rangepose::peers
