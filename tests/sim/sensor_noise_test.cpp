#include "sim/sensor_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rangepose {
namespace {

constexpr int kSize = 200;

Camera squareCamera() {
  Camera camera;
  camera.width = kSize;
  camera.height = kSize;
  camera.fx = camera.fy = 4000.0;  // nearly parallel rays: one angle for all pixels
  camera.cx = camera.cy = 0.5 * (kSize - 1);
  camera.depth_scale = 0.001;
  return camera;
}

/// A wall whose normal makes the angle with the axis of the camera, at one depth.
Image<SurfaceTexel> wall(double depth_mm, double angle_rad) {
  const glm::vec3 normal(std::sin(angle_rad), 0.0, -std::cos(angle_rad));
  return Image<SurfaceTexel>(kSize, kSize, SurfaceTexel(normal, static_cast<float>(depth_mm)));
}

SensorNoise onlyDepthNoise() {
  SensorNoise noise;
  noise.sigma_mm = 0.5;
  return noise;
}

double deviation(const Image<float>& measured, double depth_mm) {
  double sum_sq = 0.0;
  for (const float z : measured) sum_sq += (z - depth_mm) * (z - depth_mm);
  return std::sqrt(sum_sq / static_cast<double>(measured.size()));
}

double measuredDeviation(double depth_mm, double angle_rad) {
  Random random(1);
  return deviation(sensed(wall(depth_mm, angle_rad), squareCamera(), {}, onlyDepthNoise(), random),
                   depth_mm);
}

double lostShare(const Image<float>& measured) {
  int lost = 0;
  for (const float z : measured) lost += z == 0.0f ? 1 : 0;
  return static_cast<double>(lost) / static_cast<double>(measured.size());
}

TEST(SensorNoiseTest, GrowsWithTheSquareOfTheDistance) {
  EXPECT_NEAR(measuredDeviation(1000.0, 0.0), 0.5, 0.01);
  EXPECT_NEAR(measuredDeviation(2000.0, 0.0), 2.0, 0.04);
  EXPECT_NEAR(measuredDeviation(500.0, 0.0), 0.125, 0.0025);
}

TEST(SensorNoiseTest, GrowsWithTheSlope) {
  EXPECT_NEAR(measuredDeviation(1000.0, 1.0471975512), 1.0, 0.03);  // 60 degrees: cosine 0.5
}

TEST(SensorNoiseTest, RoughLosesATenthAndObliqueSurfacesMore) {
  Random random(1);
  const double facing =
      lostShare(sensed(wall(1000.0, 0.0), squareCamera(), {}, sensorNoise(2), random));
  SensorNoise no_grazing = sensorNoise(2);
  no_grazing.grazing_cosine = 0.0;
  EXPECT_NEAR(
      lostShare(sensed(wall(1000.0, 0.0), squareCamera(), {}, no_grazing, random)), 0.10, 0.01);
  const double oblique =
      lostShare(sensed(wall(1000.0, 1.3), squareCamera(), {}, sensorNoise(2), random));
  EXPECT_GT(oblique, facing + 0.1);
}

TEST(SensorNoiseTest, EdgesAreLostOrMixedAndNothingElseIs) {
  constexpr float kNear = 900.0f;
  constexpr float kFar = 950.0f;
  Image<SurfaceTexel> step = wall(kFar, 0.0);
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize / 2; ++u) step.at(u, v).w = kNear;
  }
  SensorNoise noise;
  noise.edge_loss = 0.3;
  noise.edge_mix = 0.4;
  Random random(1);
  const Image<float> measured = sensed(step, squareCamera(), {}, noise, random);
  int lost = 0;
  int mixed = 0;
  double sum_mixed = 0.0;
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) {
      const float z = measured.at(u, v);
      const bool beside = u == kSize / 2 - 1 || u == kSize / 2;
      if (!beside) {
        ASSERT_NEAR(z, u < kSize / 2 ? kNear : kFar, 1e-3) << u;
        continue;
      }
      lost += z == 0.0f ? 1 : 0;
      if (z == 0.0f || std::abs(z - kNear) < 1e-3 || std::abs(z - kFar) < 1e-3) continue;
      ++mixed;
      sum_mixed += z;
      ASSERT_GT(z, kNear);
      ASSERT_LT(z, kFar);
    }
  }
  EXPECT_NEAR(lost / (2.0 * kSize), 0.3, 0.07);
  EXPECT_NEAR(mixed / (2.0 * kSize), 0.4, 0.08);
  EXPECT_NEAR(sum_mixed / mixed, 0.5 * (kNear + kFar), 5.0);
}

TEST(SensorNoiseTest, DepthIsInWholeStepsOfTheScale) {
  Camera camera = squareCamera();
  camera.depth_scale = 0.25;
  Random random(1);
  const Image<float> measured = sensed(wall(800.0, 0.3), camera, {}, onlyDepthNoise(), random);
  bool varies = false;
  for (const float z : measured) {
    ASSERT_EQ(z / 0.25f, std::round(z / 0.25f));
    varies = varies || z != measured.at(0, 0);
  }
  EXPECT_TRUE(varies);
}

}  // namespace
}  // namespace rangepose
