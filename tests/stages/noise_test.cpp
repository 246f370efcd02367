// Noise of known size, measured.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "stages/noise_host.h"
#include "support/range_scenes.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using Formula = std::function<double(int u, int v)>;

constexpr int kWidth = 160;
constexpr int kHeight = 120;

double gaussian(test::Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform(0.0, 1.0)));
  return radius * std::cos(random.uniform(0.0, 2.0 * std::numbers::pi));
}

/// step_mm > 0: depth in whole steps.
double measured(const Formula& depth, double sigma_mm, double step_mm) {
  test::Random random(11);
  DepthImage image{test::pinholeCamera(kWidth, kHeight, 300.0), Image<float>(kWidth, kHeight)};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      double mm = depth(u, v) + sigma_mm * gaussian(random);
      if (step_mm > 0.0) mm = step_mm * std::round(mm / step_mm);
      image.depth_mm.at(u, v) = static_cast<float>(mm);
    }
  }
  return host::depthNoise(image, Image<std::uint8_t>(kWidth, kHeight, 1));
}

double tilted(int u, int v) { return 500.0 + 0.6 * u - 0.9 * v; }

class DepthNoiseTest : public testing::TestWithParam<double> {};

TEST_P(DepthNoiseTest, IsMeasuredOnATiltedPlane) {
  EXPECT_NEAR(measured(tilted, GetParam(), 0.0), GetParam(), 0.15 * GetParam());
}

TEST_P(DepthNoiseTest, IsMeasuredBesideJumpsOfDepth) {
  const auto steps = [](int u, int v) { return tilted(u, v) + (u / 40 % 2 == 0 ? 0.0 : 60.0); };
  EXPECT_NEAR(measured(steps, GetParam(), 0.0), GetParam(), 0.3 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Sizes, DepthNoiseTest, testing::Values(0.2, 1.0, 3.0));

TEST(DepthNoiseTest, PlaneWithoutNoiseHasNearlyNone) {
  EXPECT_LT(measured(tilted, 0.0, 0.0), 1e-3);
}

TEST(DepthNoiseTest, QuantisedDepthIsNotFreeOfNoise) {
  for (const double sigma : {0.3, 0.5}) {
    // Rounding adds a twelfth of the squared step. Differences in whole steps make the lower half
    // small, so the measure is low where noise is well below a step.
    const double truth = std::sqrt(sigma * sigma + 1.0 / 12.0);
    const double noise = measured(tilted, sigma, 1.0);
    EXPECT_GT(noise, 0.35 * truth) << sigma;
    EXPECT_LT(noise, 1.25 * truth) << sigma;
  }
}

TEST(DepthNoiseTest, CurvedSurfaceStaysNearTheTruth) {
  // A cylinder with a radius of about 45 mm at 300 focal pixels.
  const auto round = [](int u, int) {
    const double x = (u - 0.5 * kWidth) * 0.5;
    return 400.0 - std::sqrt(45.0 * 45.0 - x * x);
  };
  for (const double sigma : {0.3, 1.0})
    EXPECT_NEAR(measured(round, sigma, 0.0), sigma, 0.3 * sigma) << sigma;
}

/// A row of n pixels has n - 6 triples: 99, then 100.
TEST(DepthNoiseTest, TooFewTriplesGiveNone) {
  test::Random random(3);
  DepthImage image{test::pinholeCamera(kWidth, kHeight, 300.0), Image<float>(kWidth, kHeight)};
  for (float& mm : image.depth_mm) mm = static_cast<float>(500.0 + gaussian(random));
  Image<std::uint8_t> mask(kWidth, kHeight, 0);
  for (int u = 0; u < 105; ++u) mask.at(u, 10) = 1;
  EXPECT_EQ(host::depthNoise(image, mask), 0.0);
  mask.at(105, 10) = 1;
  EXPECT_GT(host::depthNoise(image, mask), 0.3);
  EXPECT_EQ(host::depthNoise(image, Image<std::uint8_t>(kWidth, kHeight, 0)), 0.0);
}

TEST(DepthNoiseTest, OnlyPixelsOfTheMaskCount) {
  test::Random random(5);
  DepthImage image{test::pinholeCamera(kWidth, kHeight, 300.0), Image<float>(kWidth, kHeight)};
  Image<std::uint8_t> mask(kWidth, kHeight, 0);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const bool kept = u < kWidth / 2;
      mask.at(u, v) = kept ? 1 : 0;
      image.depth_mm.at(u, v) = static_cast<float>(500.0 + (kept ? 0.5 : 20.0) * gaussian(random));
    }
  }
  EXPECT_NEAR(host::depthNoise(image, mask), 0.5, 0.075);
}

}  // namespace
}  // namespace rangepose
