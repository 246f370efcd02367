// Scenes with every kind of background, for the kernels of the foreground.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "stages/foreground_host.h"
#include "support/bins.h"

namespace rangepose::test {

struct ForegroundScene {
  std::string name;
  DepthImage image;
  ForegroundTask task;
};

inline void addNoise(DepthImage& image, double sigma_mm, double lost, double step_mm) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, sigma_mm);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (float& mm : image.depth_mm) {
    if (mm == 0.0f) continue;
    double depth = static_cast<double>(mm) + noise(random);
    if (step_mm > 0.0) depth = step_mm * std::round(depth / step_mm);
    mm = share(random) < lost ? 0.0f : static_cast<float>(depth);
  }
}

/// A bin with walls to the left and right, boxes, and a large sheet behind which nothing lies.
inline ForegroundScene binScene(const std::string& name, const Camera& camera) {
  const Pose bin = aboveTable(470.0);
  ForegroundScene scene{name, emptyBin(camera, bin, {-1.0, 1.0}), {}};
  measure(scene.image,
          meshOf({boxAt(50.0, -20.0, {40.0, 40.0, 20.0}), boxAt(0.0, 30.0, {50.0, 30.0, 22.0})}),
          bin);
  const Pose leaning{rotationFromVector({0.0, -0.65 * std::numbers::pi, 0.0}), {-20.0, -60.0, 2.0}};
  measure(scene.image, meshOf({{{0, 0, 0}, {80, 60, 2}}}), bin * leaning);
  scene.task.options.part_mm = 100.0;
  scene.task.options.tolerance_mm = 2.0;
  scene.task.options.flat_face = {80.0, 60.0};
  scene.task.thin_mm = 0.6;
  return scene;
}

inline std::vector<ForegroundScene> foregroundScenes() {
  std::vector<ForegroundScene> scenes;
  const Camera pinhole = pinholeCamera(320, 240, 420.0);
  scenes.push_back(binScene("clean", pinhole));
  scenes.push_back(binScene("parallel rays", parallelCamera(300, 222, 1.1)));
  scenes.push_back(binScene("noise", pinhole));
  addNoise(scenes.back().image, 0.4, 0.0, 0.0);
  scenes.push_back(binScene("a tenth lost", pinhole));
  addNoise(scenes.back().image, 0.2, 0.1, 0.0);
  scenes.push_back(binScene("few lost", pinhole));
  addNoise(scenes.back().image, 0.2, 0.01, 0.0);
  scenes.push_back(binScene("whole steps", pinhole));
  addNoise(scenes.back().image, 0.3, 0.0, 1.0);
  scenes.push_back(binScene("thick parts", pinhole));
  scenes.back().task.thin_mm = 2.0;
  scenes.push_back(binScene("large", pinholeCamera(641, 479, 830.0)));
  addNoise(scenes.back().image, 0.3, 0.05, 0.0);
  scenes.push_back(binScene("a bin box", pinhole));
  scenes.back().task.bin =
      BinBox{{aboveTable(470.0).rotation, {10.0, 0.0, 470.0}}, {150.0, 150.0, 60.0}};
  scenes.push_back(binScene("no plane asked for", pinhole));
  scenes.back().task.options.max_planes = 0;
  scenes.push_back({"nothing", {pinhole, Image<float>(320, 240, 0.0f)}, scenes.front().task});
  scenes.push_back({"three pixels", {pinhole, Image<float>(320, 240, 0.0f)}, scenes.front().task});
  for (int u = 100; u < 103; ++u) scenes.back().image.depth_mm.at(u, 50) = 400.0f;
  // Too narrow for a second difference, and all of it measured.
  scenes.push_back(
      {"six columns", {pinholeCamera(6, 90, 300.0), Image<float>(6, 90, 400.0f)}, scenes[0].task});
  scenes.push_back(
      {"one pixel", {pinholeCamera(1, 1, 300.0), Image<float>(1, 1, 400.0f)}, scenes[0].task});
  return scenes;
}

/// Planes and noise are sums in another order than the host's.
inline void expectLike(const Foreground& actual, const Foreground& host) {
  constexpr double kOtherOrder = 1e-10;  // of what they are; planes are less than 1 m away
  EXPECT_NEAR(actual.noise_mm, host.noise_mm, kOtherOrder * host.noise_mm);
  EXPECT_EQ(actual.depth.depth_mm, host.depth.depth_mm);
  ASSERT_EQ(actual.background.size(), host.background.size());
  for (std::size_t i = 0; i < host.background.size(); ++i) {
    const BackgroundPlane& plane = host.background[i];
    EXPECT_LT(glm::distance(actual.background[i].normal, plane.normal), kOtherOrder) << i;
    EXPECT_NEAR(actual.background[i].offset_mm, plane.offset_mm, kOtherOrder * 1000.0) << i;
  }
  EXPECT_EQ(actual.mask, host.mask);
}

}  // namespace rangepose::test
