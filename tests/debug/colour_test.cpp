#include "debug/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>

#include "debug/canvas.h"

namespace rangepose::debug {
namespace {

std::tuple<int, int, int> key(const cv::Vec3b& colour) { return {colour[0], colour[1], colour[2]}; }

TEST(ColourTest, MissingPixelsAreDarkGreyAndNoScaleContainsThatGrey) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const bool signed_field : {false, true}) {
    const ColourScale scale{"depth", "mm", -5.0f, 5.0f, true, signed_field};
    Image<float> values(3, 1, 0.0f);
    values.at(1, 0) = nan;
    values.at(2, 0) = 2.0f;
    const cv::Mat pixels = colourPixels(values, scale);
    EXPECT_EQ(pixels.at<cv::Vec3b>(0, 0), kMissingColour);
    EXPECT_EQ(pixels.at<cv::Vec3b>(0, 1), kMissingColour);
    EXPECT_NE(pixels.at<cv::Vec3b>(0, 2), kMissingColour);
    for (int i = -500; i <= 500; ++i) {
      if (i == 0) continue;
      EXPECT_NE(colourOf(static_cast<float>(i) / 100.0f, scale), kMissingColour) << i;
    }
  }
}

TEST(ColourTest, ZeroIsAValueWhereTheScaleSaysSo) {
  const ColourScale scale{"distance", "px", -8.0f, 8.0f, false, true};
  EXPECT_NE(colourOf(0.0f, scale), kMissingColour);
}

TEST(ColourTest, BrightnessOfTheUnsignedMapGrowsWithTheValue) {
  const ColourScale scale{"depth", "mm", 10.0f, 20.0f, true, false};
  double last = -1.0;
  for (int i = 0; i <= 20; ++i) {
    const cv::Vec3b colour = colourOf(10.0f + 0.5f * static_cast<float>(i), scale);
    const double luma = 0.114 * colour[0] + 0.587 * colour[1] + 0.299 * colour[2];
    EXPECT_GT(luma, last) << i;
    last = luma;
  }
}

TEST(ColourTest, SignedMapIsBlueBelowRedAboveAndPaleAtZero) {
  const ColourScale scale{"difference", "mm", -4.0f, 4.0f, false, true};
  const cv::Vec3b below = colourOf(-4.0f, scale);
  const cv::Vec3b zero = colourOf(0.0f, scale);
  const cv::Vec3b above = colourOf(4.0f, scale);
  EXPECT_GT(below[0], below[2] + 100);
  EXPECT_GT(above[2], above[0] + 100);
  EXPECT_GT(std::min({zero[0], zero[1], zero[2]}), 230);
}

TEST(ColourTest, ValuesBeyondTheScaleTakeTheColourOfItsEnds) {
  const ColourScale scale{"depth", "mm", 10.0f, 20.0f, true, false};
  EXPECT_EQ(colourOf(1.0f, scale), colourOf(10.0f, scale));
  EXPECT_EQ(colourOf(99.0f, scale), colourOf(20.0f, scale));
}

TEST(ColourTest, BarRunsFromTheMaximumOnTopToTheMinimum) {
  const ColourScale scale{"depth", "mm", 412.0f, 517.0f, true, false};
  const cv::Mat bar = colourBar(scale, 300);
  ASSERT_EQ(bar.rows, 300);
  EXPECT_EQ(bar.at<cv::Vec3b>(kBarMarginPx, 3), colourOf(517.0f, scale));
  EXPECT_EQ(bar.at<cv::Vec3b>(300 - kBarMarginPx - 1, 3), colourOf(412.0f, scale));
  EXPECT_EQ(bar.at<cv::Vec3b>(kBarMarginPx - 1, 3), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(bar.at<cv::Vec3b>(300 - kBarMarginPx, 3), cv::Vec3b(255, 255, 255));
}

/// Dark pixels in a part of a picture: ink of text and ticks.
int ink(const cv::Mat& part) {
  int count = 0;
  for (int y = 0; y < part.rows; ++y) {
    for (int x = 0; x < part.cols; ++x) count += part.at<cv::Vec3b>(y, x)[1] < 160 ? 1 : 0;
  }
  return count;
}

TEST(ColourTest, BarPrintsItsEndsAndItsUnit) {
  const ColourScale scale{"depth", "mm", 412.0f, 517.0f, true, false};
  const cv::Mat bar = colourBar(scale, 300);
  const int right = bar.cols - kBarStripPx;
  EXPECT_GT(ink(bar(cv::Rect(kBarStripPx + 6, 0, right - 26, 20))), 20) << "maximum";
  EXPECT_GT(ink(bar(cv::Rect(kBarStripPx + 6, 280, right - 26, 20))), 20) << "minimum";
  EXPECT_GT(ink(bar(cv::Rect(bar.cols - 14, 80, 14, 140))), 40) << "name and unit";
  // Another end, other numbers.
  const cv::Mat other = colourBar({"depth", "mm", 412.0f, 698.0f, true, false}, 300);
  const cv::Rect top(kBarStripPx + 6, 0, 26, 20);
  EXPECT_GT(cv::norm(bar(top), other(top), cv::NORM_INF), 100.0);
}

TEST(ColourTest, ScaleLeavesOutliersAndMissingPixelsAside) {
  Image<float> values(100, 100, 0.0f);
  for (int y = 0; y < 100; ++y) {
    for (int x = 10; x < 100; ++x) values.at(x, y) = 500.0f + static_cast<float>(x);
  }
  values.at(50, 50) = 9000.0f;
  const ColourScale scale = scaleOf(values, "depth", "mm");
  EXPECT_NEAR(scale.min, 510.0f, 1.0f);
  EXPECT_NEAR(scale.max, 599.0f, 1.0f);
}

TEST(ColourTest, ScaleOfAnEmptyOrConstantFieldCanBeDrawn) {
  const Image<float> nothing(40, 30, 0.0f);
  const Image<float> constant(40, 30, 7.0f);
  for (const Image<float>& values : {nothing, constant}) {
    const ColourScale scale = scaleOf(values, "depth", "mm");
    EXPECT_LT(scale.min, scale.max);
    EXPECT_FALSE(colourMap(values, scale).empty());
  }
}

TEST(ColourTest, MapShowsEveryValueAsASquareBesideItsBar) {
  Image<float> values(40, 30, 3.0f);
  values.at(39, 29) = 0.0f;
  values.at(0, 0) = 5.0f;
  const ColourScale scale{"range", "px", 3.0f, 5.0f, true, false};
  const cv::Mat map = colourMap(values, scale, 200);
  ASSERT_EQ(enlargement(40, 30, 200), 5);
  EXPECT_EQ(map.at<cv::Vec3b>(4, 4), colourOf(5.0f, scale));
  EXPECT_EQ(map.at<cv::Vec3b>(4, 5), colourOf(3.0f, scale));
  EXPECT_EQ(map.at<cv::Vec3b>(149, 199), kMissingColour);
  EXPECT_EQ(map.at<cv::Vec3b>(kBarMarginPx, 200 + kGapPx), colourOf(5.0f, scale));
}

TEST(ColourTest, LabelsHaveStableDistinctColoursThatAreNotTheMissingOne) {
  std::set<std::tuple<int, int, int>> seen;
  for (std::int32_t label = 0; label < 200; ++label) {
    EXPECT_EQ(labelColour(label), labelColour(label));
    EXPECT_NE(labelColour(label), kMissingColour);
    seen.insert(key(labelColour(label)));
  }
  EXPECT_GT(seen.size(), 190U);
  EXPECT_EQ(labelColour(-1), kMissingColour);
  for (std::int32_t label = 0; label < 100; ++label) {
    EXPECT_GT(cv::norm(cv::Vec3i(labelColour(label)) - cv::Vec3i(labelColour(label + 1))), 15.0)
        << label;
  }
}

TEST(CanvasTest, TicksAreRoundAndInside) {
  const std::vector<double> ticks = roundTicks(0.13, 0.88, 5);
  ASSERT_EQ(ticks.size(), 4U);
  EXPECT_NEAR(ticks.front(), 0.2, 1e-12);
  EXPECT_NEAR(ticks.back(), 0.8, 1e-12);
  EXPECT_TRUE(roundTicks(1.0, 1.0, 5).empty());
}

TEST(CanvasTest, PlatesStayOnTheCanvas) {
  const cv::Rect canvas(0, 0, 300, 200);
  for (const cv::Point corner : {cv::Point(-50, -50), cv::Point(290, 195), cv::Point(20, 20)}) {
    const cv::Rect plate = plateOf(canvas.size(), corner, "label 0.9");
    EXPECT_EQ(plate & canvas, plate);
  }
}

}  // namespace
}  // namespace rangepose::debug
