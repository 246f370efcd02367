// Noise and error of surfaces whose poses are known.
#include "eval/surface_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "eval/scan_scene.h"
#include "eval/scan_statistics.h"

namespace rangepose {
namespace {

using test::LeaningPlate;

ScanStatistics measured(const DepthImage& image, const std::vector<KnownPart>& parts) {
  return statisticsOf(tallyScan(image, parts));
}

TEST(SurfaceErrors, WhiteNoiseHasNothingInCommon) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  test::addNoise(image, test::whiteNoise(320, 240, 1), 0.5);
  const ScanStatistics figures = measured(image, {plate.part()});
  EXPECT_GT(figures.pixels, 20000);
  EXPECT_NEAR(figures.noise_mm, 0.5, 0.01);
  EXPECT_NEAR(figures.rms_mm, 0.5, 0.01);
  EXPECT_NEAR(figures.mean_size_mm, 0.5 * std::sqrt(2.0 / 3.14159265), 0.01);
  for (std::size_t i = 0; i < kErrorShiftsPx.size(); ++i) {
    EXPECT_NEAR(figures.difference_mm[i], 0.5, 0.015) << kErrorShiftsPx[i] << " px";
    EXPECT_NEAR(figures.correlation[i], 0.0, 0.03) << kErrorShiftsPx[i] << " px";
  }
}

TEST(SurfaceErrors, CommonErrorGrowsUpToItsWidthThatNeighboursDoNotShow) {
  constexpr int kWide = 7;
  const LeaningPlate plate;
  ScanTally tally;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    DepthImage image = plate.scan();
    test::addNoise(image, test::commonNoise(320, 240, kWide, seed), 0.8);
    tally.add(tallyScan(image, {plate.part()}));
  }
  const ScanStatistics figures = statisticsOf(tally);
  EXPECT_EQ(figures.images, 4);
  EXPECT_NEAR(figures.rms_mm, 0.8, 0.04);
  // Second differences: 6 - 8 (1 - 1 / w) + 2 (1 - 2 / w) of the variance, over 6.
  EXPECT_NEAR(figures.noise_mm, 0.8 * std::sqrt(4.0 / kWide / 6.0), 0.02);
  for (std::size_t i = 0; i < kErrorShiftsPx.size(); ++i) {
    const double common = std::max(0.0, 1.0 - static_cast<double>(kErrorShiftsPx[i]) / kWide);
    EXPECT_NEAR(figures.correlation[i], common, 0.06) << kErrorShiftsPx[i] << " px";
    EXPECT_NEAR(figures.difference_mm[i], 0.8 * std::sqrt(1.0 - common), 0.04)
        << kErrorShiftsPx[i] << " px";
  }
}

TEST(SurfaceErrors, StepsOfDepthDoNotHideTheNoise) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  test::addNoise(image, test::whiteNoise(320, 240, 2), 0.2);
  for (float& depth : image.depth_mm) depth = std::round(depth);
  const ScanStatistics figures = measured(image, {plate.part()});
  // Rounding to whole mm adds a variance of 1 / 12.
  EXPECT_NEAR(figures.noise_mm, std::sqrt(0.04 + 1.0 / 12.0), 0.02);
  EXPECT_NEAR(figures.common_step_mm, 1.0, 1e-9);
  EXPECT_NEAR(figures.gap_mm, 1.0, 1e-6);
}

TEST(SurfaceErrors, FewOddValuesAreNoSmallerStep) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  int count = 0;
  for (float& depth : image.depth_mm) {
    depth = 2.5f * std::round(depth / 2.5f);
    if (depth > 0.0f && ++count % 50 == 0) depth += 0.3f;
  }
  EXPECT_NEAR(measured(image, {plate.part()}).common_step_mm, 2.5, 1e-9);
}

TEST(SurfaceErrors, SmallMotionOfAPartIsNoErrorOfTheSensor) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  test::addNoise(image, test::whiteNoise(320, 240, 3), 0.1);
  KnownPart moved = plate.part();
  moved.camera_from_object.translation_mm += glm::dvec3(0.4, -0.3, 1.5);
  moved.camera_from_object.rotation =
      rotationFromVector({0.01, -0.008, 0.0}) * moved.camera_from_object.rotation;
  const ScanStatistics figures = measured(image, {moved});
  EXPECT_NEAR(figures.rms_mm, 0.1, 0.01);
  EXPECT_NEAR(figures.difference_mm.back(), 0.1, 0.01);
}

TEST(SurfaceErrors, WhatLiesOnAPartIsNoErrorOfTheSensor) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  test::addNoise(image, test::whiteNoise(320, 240, 4), 0.1);
  for (int v = 60; v < 180; ++v) {
    for (int u = 100; u < 160; ++u) image.depth_mm.at(u, v) -= 30.0f;
  }
  EXPECT_NEAR(measured(image, {plate.part()}).rms_mm, 0.1, 0.005);
}

TEST(SurfaceErrors, FewBadPixelsDoNotMoveAPart) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  test::addNoise(image, test::whiteNoise(320, 240, 6), 0.1);
  const auto isBad = [](int u, int v) { return u < 120 && v < 120; };
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 120; ++u) image.depth_mm.at(u, v) -= 6.0f;
  }
  const KnownSurface known = renderKnown({plate.part()}, image.camera);
  const Image<float> errors = surfaceErrors(image, known, {plate.part()});
  double squares = 0.0;
  int count = 0;
  for (int v = 0; v < errors.height(); ++v) {
    for (int u = 0; u < errors.width(); ++u) {
      if (std::isnan(errors.at(u, v)) || isBad(u, v)) continue;
      squares += static_cast<double>(errors.at(u, v)) * errors.at(u, v);
      ++count;
    }
  }
  EXPECT_GT(count, 15000);
  EXPECT_NEAR(std::sqrt(squares / count), 0.1, 0.01);
}

TEST(SurfaceErrors, WhatASensorMakesOfContoursIsToldApart) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  test::addNoise(image, test::whiteNoise(320, 240, 5), 0.1);
  const KnownSurface known = renderKnown({plate.part()}, image.camera);
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      if (known.at(u, v).part >= 0 && known.at(u, v).inside_px < kDeepPx) {
        image.depth_mm.at(u, v) += (u + v) % 2 == 0 ? 2.0f : -2.0f;
      }
    }
  }
  const ScanStatistics figures = measured(image, {plate.part()});
  EXPECT_GT(figures.rms_mm, 0.5);
  EXPECT_NEAR(figures.deep_rms_mm, 0.1, 0.01);
}

TEST(SurfaceErrors, PartsThatDoNotCountOnlyHideOthers) {
  const LeaningPlate plate;
  const test::BlockOnFloor block;
  KnownPart hider = block.part();
  hider.camera_from_object.translation_mm.z = 350.0;
  hider.counted = false;
  DepthImage image = plate.scan();
  const ScanStatistics alone = measured(image, {plate.part()});
  const ScanStatistics hidden = measured(image, {plate.part(), hider});
  EXPECT_EQ(hidden.parts, 1);
  EXPECT_GT(hidden.pixels, 5000);
  EXPECT_LT(hidden.pixels, alone.pixels - 100 * 100) << "the hider covers 115 x 115 pixels";
  hider.counted = true;
  EXPECT_EQ(measured(image, {plate.part(), hider}).parts, 2);
}

TEST(SurfaceErrors, NothingMeasuredIsNoFigure) {
  const LeaningPlate plate;
  DepthImage image = plate.scan();
  for (float& depth : image.depth_mm) depth = 0.0f;
  const ScanStatistics figures = measured(image, {plate.part()});
  EXPECT_EQ(figures.pixels, 0);
  EXPECT_TRUE(std::isnan(figures.noise_mm));
  EXPECT_TRUE(std::isnan(figures.rms_mm));
  EXPECT_TRUE(std::isnan(figures.common_step_mm));
  EXPECT_TRUE(std::isnan(figures.smear_px));
  EXPECT_EQ(figures.lost_share, 1.0);
}

}  // namespace
}  // namespace rangepose
