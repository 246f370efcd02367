// What a pose accounts for: counted wrongly, a part that lies the wrong way round is preferred, or
// a part beside a found one is taken out with it.
#include "pipeline/explained_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/shapes.h"

namespace rangepose {
namespace {

/// A rendered plane at 500 mm that faces the camera, and data at distances from it.
class ExplainedPixelsTest : public testing::Test {
 protected:
  ExplainedPixelsTest() {
    image_.camera = test::pinholeCamera(40, 30, 100.0);
    image_.depth_mm = Image<float>(40, 30, 0.0f);
    window_.x0 = 10;
    window_.y0 = 5;
    window_.width = window_.height = 16;
    options_.tolerance_mm = 2.0;
  }

  /// Row y of the window lies `off_mm` behind the plane.
  void setRow(int y, float off_mm) {
    for (int x = 0; x < window_.width; ++x)
      image_.depth_mm.at(window_.x0 + x, window_.y0 + y) = 500.0f + off_mm;
  }
  std::vector<NearPixel> near() const {
    return judgedPixels(surface_, window_, image_, options_).near;
  }

  DepthImage image_;
  SurfaceWindow window_;
  CheckOptions options_;
  Image<SurfaceTexel> surface_{16, 16, SurfaceTexel(0.0f, 0.0f, -1.0f, 500.0f)};
};

TEST_F(ExplainedPixelsTest, NothingIsExplainedWhereNothingWasMeasured) {
  EXPECT_TRUE(near().empty());
  EXPECT_TRUE(explainedPixels(surface_, window_, image_, 2.0).empty());
}

TEST_F(ExplainedPixelsTest, PixelsAreThoseOfTheImageWithinTheDistance) {
  setRow(3, 1.5f);
  setRow(7, -1.5f);
  setRow(9, 2.5f);
  const std::vector<std::int32_t> pixels = explainedPixels(surface_, window_, image_, 2.0);
  ASSERT_EQ(pixels.size(), 32u);
  EXPECT_EQ(pixels.front(), 8 * 40 + 10);
  EXPECT_EQ(pixels.back(), 12 * 40 + 25);
  EXPECT_TRUE(std::is_sorted(pixels.begin(), pixels.end()));
}

TEST_F(ExplainedPixelsTest, NearPixelsTellHowNearAndWhatWasSeenThrough) {
  setRow(0, 0.75f);
  setRow(1, 30.0f);
  setRow(2, -3.0f);   // just behind the data
  setRow(3, -30.0f);  // something lies on it
  const std::vector<NearPixel> pixels = near();
  ASSERT_EQ(pixels.size(), 32u);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(pixels[i].gap_mm, 0.75f, 1e-4f);
    EXPECT_EQ(pixels[16 + i].gap_mm, kSeenThrough);
  }
}

constexpr auto kAll = [](std::int32_t) { return true; };
using Near = std::vector<NearPixel>;

TEST(VotesTest, APixelVotesForThePoseThatIsCloserByFar) {
  const Near close{{3, 0.1f}, {5, 0.2f}, {9, 0.1f}};
  const Near far{{3, 1.5f}, {5, 0.3f}, {9, 0.7f}};
  const Votes votes = votesBetween(close, far, 0.4, kAll);
  EXPECT_EQ(votes.first, 2.0) << "pixel 5 is close to both";
  EXPECT_EQ(votes.second, 0.0);
  EXPECT_GT(votes.logOdds(), 0.0);
  const Votes turned = votesBetween(far, close, 0.4, kAll);
  EXPECT_EQ(turned.second, votes.first);
  EXPECT_DOUBLE_EQ(turned.logOdds(), -votes.logOdds());
}

TEST(VotesTest, WhatOnlyOnePoseShowsCountsHalf) {
  const Near more{{1, 0.0f}, {2, 0.0f}, {4, 1.0f}};
  EXPECT_EQ(votesBetween(more, {{2, 0.0f}}, 0.4, kAll).first, 0.5) << "pixel 4 is close to neither";
  EXPECT_EQ(votesBetween({}, more, 0.4, kAll).second, 1.0);
}

TEST(VotesTest, ThePoseThatTheSensorSawThroughLosesThePixel) {
  const Near through{{1, kSeenThrough}, {2, kSeenThrough}, {3, 0.0f}};
  const Near other{{2, kSeenThrough}, {3, 0.0f}};
  const Votes votes = votesBetween(through, other, 0.4, kAll);
  EXPECT_EQ(votes.first, 0.0);
  EXPECT_EQ(votes.second, 1.0) << "both lose pixel 2";
}

TEST(VotesTest, PixelsOfOthersHaveNoVote) {
  const Near more{{1, 0.0f}, {2, 0.0f}};
  const auto odd = [](std::int32_t at) { return at % 2 == 1; };
  EXPECT_EQ(votesBetween(more, {}, 0.4, odd).first, 0.5);
  EXPECT_EQ(votesBetween({}, {}, 0.4, odd).logOdds(), 0.0) << "nothing to tell them apart by";
}

}  // namespace
}  // namespace rangepose
