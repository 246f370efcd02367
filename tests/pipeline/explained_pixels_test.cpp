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
  double explained(double close_mm) const {
    return NearSurface(surface_, window_, image_, options_).explainedMm2(close_mm);
  }
  /// Of a row of the window.
  static double rowMm2() { return 16.0 * 5.0 * 5.0; }

  DepthImage image_;
  SurfaceWindow window_;
  CheckOptions options_;
  Image<SurfaceTexel> surface_{16, 16, SurfaceTexel(0.0f, 0.0f, -1.0f, 500.0f)};
};

TEST_F(ExplainedPixelsTest, NothingIsExplainedWhereNothingWasMeasured) {
  EXPECT_EQ(explained(1.0), 0.0);
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

TEST_F(ExplainedPixelsTest, CloseSurfaceCountsInFullAndLessUpToTwiceAsFar) {
  setRow(0, 0.2f);
  EXPECT_NEAR(explained(0.5), rowMm2(), 1e-3);
  setRow(0, -0.75f);
  EXPECT_NEAR(explained(0.5), 0.5 * rowMm2(), 0.04 * rowMm2()) << "but for the width of a bin";
  setRow(0, 1.1f);
  EXPECT_NEAR(explained(0.5), 0.0, 1e-9);
  EXPECT_NEAR(explained(1.2), rowMm2(), 1e-3);
}

TEST_F(ExplainedPixelsTest, SurfaceInFrontOfTheDataCountsAgainstAndBehindItNotAtAll) {
  setRow(0, 0.0f);
  setRow(1, 30.0f);
  EXPECT_NEAR(explained(0.5), 0.0, 1e-3);
  setRow(1, -3.0f);
  EXPECT_NEAR(explained(0.5), rowMm2(), 1e-3) << "just behind the data";
  setRow(1, -30.0f);
  EXPECT_NEAR(explained(0.5), rowMm2(), 1e-3) << "something lies on it";
}

}  // namespace
}  // namespace rangepose
