#include "core/image.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "core/timings.h"

namespace rangepose {
namespace {

TEST(ImageTest, PixelsLieRowAfterRow) {
  Image<int> image(5, 3);
  std::iota(image.begin(), image.end(), 0);
  EXPECT_EQ(image.at(0, 0), 0);
  EXPECT_EQ(image.at(4, 0), 4);
  EXPECT_EQ(image.at(2, 1), 7);
  EXPECT_EQ(image.row(2)[3], 13);
  EXPECT_EQ(image.data() + 10, image.row(2));
  EXPECT_EQ(image.size(), 15U);
}

TEST(ImageTest, ContainsKnowsAllFourBorders) {
  const Image<float> image(5, 3);
  for (const auto& [x, y] : {std::pair{0, 0}, {4, 0}, {0, 2}, {4, 2}}) {
    EXPECT_TRUE(image.contains(x, y)) << x << ", " << y;
  }
  for (const auto& [x, y] : {std::pair{-1, 0}, {5, 0}, {0, -1}, {0, 3}, {5, 3}}) {
    EXPECT_FALSE(image.contains(x, y)) << x << ", " << y;
  }
}

TEST(ImageTest, StartsWithTheGivenValueAndComparesSizeToo) {
  EXPECT_EQ(Image<float>(4, 3, 2.5f).at(3, 2), 2.5f);
  EXPECT_EQ(Image<int>(4, 3), Image<int>(4, 3));
  EXPECT_NE(Image<int>(4, 3), Image<int>(3, 4));
  EXPECT_TRUE(Image<int>().empty());
  EXPECT_TRUE(Image<int>(0, 7).empty());
}

TEST(ImageTest, NegativeSizeIsRefusedWithItsNumbers) {
  try {
    const Image<int> image(-2, 7);
    FAIL() << "a negative size was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("-2x7"), std::string::npos) << error.what();
  }
}

TEST(ImageTest, BoxesAreHalfOpen) {
  EXPECT_EQ((PixelBox{2, 3, 7, 4}).width(), 5);
  EXPECT_EQ((PixelBox{2, 3, 7, 4}).height(), 1);
  EXPECT_FALSE((PixelBox{2, 3, 7, 4}).empty());
  EXPECT_TRUE((PixelBox{2, 3, 2, 9}).empty());
  EXPECT_TRUE(PixelBox{}.empty());
}

TEST(TimingsTest, TheSameStageAddsUpAndOrderStays) {
  StageTimes times;
  for (const char* stage : {"edges", "search", "edges"}) const ScopedTimer timer(times, stage);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].stage, "edges");
  EXPECT_EQ(times[1].stage, "search");
  EXPECT_GE(times[0].ms, 0.0);
}

}  // namespace
}  // namespace rangepose
