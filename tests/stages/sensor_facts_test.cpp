// What an image tells of its sensor: taken for finer than it is, right poses are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stages/sensor_facts_host.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

/// Ground at 600 mm, and on it blocks 80 mm high. `between` lays pixels of a jump, left and right.
template <typename Between>
DepthImage blocks(int smeared_px, const Between& between) {
  DepthImage image{test::pinholeCamera(640, 480, 600.0), Image<float>(640, 480, 600.0f)};
  constexpr int kPitch = 80;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const int in = u % kPitch;
      if (in >= 20 && in < 60) image.depth_mm.at(u, v) = 520.0f;
      for (int k = 0; k < smeared_px; ++k) {
        const float share =
            (static_cast<float>(k) + 1.0f) / (static_cast<float>(smeared_px) + 1.0f);
        if (in == 60 + k) image.depth_mm.at(u, v) = between(share);
        if (in == 19 - k) image.depth_mm.at(u, v) = between(share);
      }
    }
  }
  return image;
}

TEST(SensorFactsTest, SharpJumpsAreSharp) {
  const SensorFacts facts = host::sensorFacts(blocks(0, [](float) { return 0.0f; }), 0.1);
  EXPECT_LE(facts.jump_px, 0.5);
  EXPECT_EQ(facts.hole_px, 0.0);
  EXPECT_EQ(facts.lost, 0.0);
}

TEST(SensorFactsTest, SmearedJumpsAreAsWideAsTheyAre) {
  // Six pixels on a ramp from 1/7 to 6/7: four of them between 15 and 85 %.
  const SensorFacts facts =
      host::sensorFacts(blocks(6, [](float share) { return 520.0f + 80.0f * share; }), 0.1);
  EXPECT_NEAR(facts.jump_px, 4.0, 0.5);
  EXPECT_EQ(facts.hole_px, 0.0);
}

TEST(SensorFactsTest, HolesBesideJumpsAreCounted) {
  const SensorFacts facts = host::sensorFacts(blocks(3, [](float) { return 0.0f; }), 0.1);
  EXPECT_NEAR(facts.hole_px, 3.0, 0.2);
  EXPECT_LE(facts.jump_px, 0.5);
  EXPECT_GT(facts.lost, 0.03);
}

TEST(SensorFactsTest, StepsOfDepthAreNoiseThatNeighboursDoNotShow) {
  DepthImage image{test::pinholeCamera(320, 240, 600.0), Image<float>(320, 240, 0.0f)};
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u)
      image.depth_mm.at(u, v) = std::round(500.0f + 0.07f * static_cast<float>(u));
  }
  const SensorFacts facts = host::sensorFacts(image, 0.0);
  EXPECT_NEAR(facts.step_mm, 1.0, 1e-4);
  EXPECT_NEAR(facts.noise_mm, 1.0 / std::sqrt(12.0), 1e-4) << "right poses would seem to be off";
}

TEST(SensorFactsTest, NoiseWithoutStepsStaysWhatItIs) {
  DepthImage image{test::pinholeCamera(320, 240, 600.0), Image<float>(320, 240, 0.0f)};
  std::mt19937_64 bits(5);
  for (float& depth : image.depth_mm) {
    double sum = 0.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(bits() >> 11) * 0x1.0p-53;
    depth = 500.0f + 0.3f * static_cast<float>(sum - 6.0);
  }
  EXPECT_NEAR(host::sensorFacts(image, 0.3).noise_mm, 0.3, 0.01);
}

/// A cosine is an error that near neighbours share; its standard deviation is that of its size by
/// the root of two.
TEST(SensorFactsTest, TheErrorHoldsWhatNeighboursShare) {
  DepthImage image{test::pinholeCamera(640, 480, 600.0), Image<float>(640, 480, 0.0f)};
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const float wave =
          std::cos(0.7f * static_cast<float>(u)) * std::cos(0.7f * static_cast<float>(v));
      image.depth_mm.at(u, v) = 500.0f + 0.1f * static_cast<float>(u) + 2.0f * wave;
    }
  }
  EXPECT_NEAR(host::sensorFacts(image, 0.4).error_mm, 1.0, 0.15)
      << "right poses would seem to be off";
  // So much more than neighbours differ by is the shape of things, not the sensor's error.
  const SensorFacts quiet = host::sensorFacts(image, 0.1);
  EXPECT_DOUBLE_EQ(quiet.error_mm, 3.0 * quiet.noise_mm);
}

TEST(SensorFactsTest, RoundPartsAndJumpsAreNoError) {
  DepthImage image{test::pinholeCamera(640, 480, 600.0), Image<float>(640, 480, 600.0f)};
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const float across = static_cast<float>(u % 80 - 40) / 40.0f;
      if (v % 160 < 120)
        image.depth_mm.at(u, v) = 600.0f - 40.0f * std::sqrt(1.0f - 0.9f * across * across);
    }
  }
  EXPECT_LE(host::sensorFacts(image, 0.05).error_mm, 0.1)
      << "tolerances would be wider than the sensor is bad";
}

TEST(SensorFactsTest, AnEmptyImageTellsNothing) {
  const DepthImage image{test::pinholeCamera(64, 48, 60.0), Image<float>(64, 48, 0.0f)};
  const SensorFacts facts = host::sensorFacts(image, 0.0);
  EXPECT_EQ(facts.noise_mm, 0.0);
  EXPECT_EQ(facts.lost, 0.0);
}

}  // namespace
}  // namespace rangepose
