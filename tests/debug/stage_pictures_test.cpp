#include "debug/stage_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "debug/colour.h"
#include "debug/plots.h"
#include "debug/scenes.h"
#include "debug/small_database.h"

namespace rangepose::debug {
namespace {

using testing::smallObject;
using testing::smallScene;

/// How many pixels have a colour.
int countOf(const cv::Mat& picture, const cv::Vec3b& colour) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) count += picture.at<cv::Vec3b>(y, x) == colour ? 1 : 0;
  }
  return count;
}

TEST(StagePictureTest, BackgroundIsTintedOnlyWhereItIsNotKept) {
  const Mesh mesh = testing::box(60, 40, 20);
  const DepthImage image = testing::scan(mesh, testing::facing(0, 0, 300), 500.0f);
  Image<std::uint8_t> keep(160, 120, 1);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 80; ++x) keep.at(x, y) = 0;
  }
  const cv::Mat picture = keepMaskPicture(image, keep);
  const int zoom = 960 / 160;
  const int top = picture.rows - 120 * zoom;
  EXPECT_EQ(testing::toneOf(picture.at<cv::Vec3b>(top + 60 * zoom, 20 * zoom)),
            testing::Tone::kRed);
  EXPECT_EQ(testing::toneOf(picture.at<cv::Vec3b>(top + 60 * zoom, 140 * zoom)),
            testing::Tone::kGrey);
}

TEST(StagePictureTest, BestViewShowsTheDifferenceToTheScene) {
  // The scene is the view itself, moved by the hypothesis: the difference is 0 everywhere.
  const ReferenceObject object = smallObject(2);
  SceneChannels window = smallScene(64, 64);
  window.range_px = Image<float>(64, 64, 0.0f);
  Hypothesis hypothesis;
  hypothesis.translation_px = {3.0f, -5.0f, 140.0f};
  hypothesis.error = 0.5f;
  for (int v = 0; v < 32; ++v) {
    for (int u = 0; u < 32; ++u) {
      const float range = object.atlas.at(u, v).g;
      if (range > 0.0f) window.range_px.at(u + 16 + 3, v + 16 - 5) = range - 32.0f + 140.0f;
    }
  }
  const ColourScale scale{"", "", -8.0f, 8.0f, false, true};
  const auto rightField = [&](const SceneChannels& scene) {
    const cv::Mat picture = bestViewPicture(object, {scene}, {hypothesis});
    const int zoom = 384 / 64;
    const cv::Mat bar = colourBar({"scene - view", "px", -8.0f, 8.0f, false, true}, 64 * zoom);
    const int left = picture.cols - bar.cols - 12 - 64 * zoom;
    return cv::Mat(picture(cv::Rect(left, picture.rows - 64 * zoom, 64 * zoom, 64 * zoom)));
  };
  const int all = static_cast<int>(object.views[0].area_px) * (384 / 64) * (384 / 64);
  EXPECT_EQ(countOf(rightField(window), colourOf(0.0f, scale)), all);
  for (float& range : window.range_px) {
    if (range > 0.0f) range += 4.0f;
  }
  EXPECT_EQ(countOf(rightField(window), colourOf(4.0f, scale)), all);
}

TEST(PlotTest, BestViewIsCircledWhereItIsSeenFrom) {
  ReferenceObject object = smallObject(2);
  object.views[0].rotation = glm::dmat3(1.0);  // looks along +z: elevation 90
  object.views[1].rotation = rotationFromVector({1.5707963267948966, 0, 0});  // along the horizon
  std::vector<Hypothesis> hypotheses(2);
  hypotheses[0].view = 0;
  hypotheses[0].error = 3.0f;
  hypotheses[1].view = 1;
  hypotheses[1].error = 1.0f;
  const cv::Mat plot = errorOverDirections(object, hypotheses);
  const cv::Vec3b ring(60, 60, 255);
  cv::Point2d sum(0, 0);
  int count = 0;
  for (int y = 0; y < plot.rows; ++y) {
    for (int x = 0; x < plot.cols; ++x) {
      if (plot.at<cv::Vec3b>(y, x) != ring) continue;
      sum += cv::Point2d(x, y);
      ++count;
    }
  }
  ASSERT_GT(count, 10);
  EXPECT_NEAR(sum.y / count, 12 + 180, 3.0) << "elevation 0 lies in the middle of the map";
  const glm::dmat3& r = object.views[1].rotation;
  const double azimuth = std::atan2(r[1][2], r[0][2]);
  EXPECT_NEAR(sum.x / count, 64 + (azimuth / 3.14159265 + 1.0) * 360.0, 3.0);
}

}  // namespace
}  // namespace rangepose::debug
