#include "debug/overlay.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "debug/relief.h"
#include "debug/scenes.h"

namespace rangepose::debug {
namespace {

using testing::box;
using testing::facing;
using testing::pixelOf;
using testing::posed;
using testing::scan;
using testing::Tone;
using testing::toneOf;

// A box of 60 x 40 x 20 mm whose front face is seen squarely at 290 mm: 31 x 21 px about
// (79.5, 59.5). Points are taken off its centre, where the axes are drawn.
constexpr int kInsideU = 70;
constexpr int kInsideV = 54;

class OverlayTest : public ::testing::Test {
 protected:
  const Mesh mesh_ = box(60, 40, 20);
  const Pose truth_ = facing(0, 0, 300);
};

TEST_F(OverlayTest, AgreeingPixelsAreGreen) {
  const OverlayPicture picture = drawOverlay(scan(mesh_, truth_, 500), {posed(mesh_, truth_)});
  EXPECT_EQ(toneOf(pixelOf(picture, picture.overlay, kInsideU, kInsideV)), Tone::kGreen);
  ASSERT_EQ(picture.zooms.size(), 1U);
  EXPECT_EQ(toneOf(pixelOf(picture, picture.zooms[0], kInsideU, kInsideV)), Tone::kGreen);
}

TEST_F(OverlayTest, ModelInFrontOfTheDataIsRed) {
  const OverlayPicture picture =
      drawOverlay(scan(mesh_, truth_, 500), {posed(mesh_, facing(0, 0, 270))});
  EXPECT_EQ(toneOf(pixelOf(picture, picture.overlay, kInsideU, kInsideV)), Tone::kRed);
  EXPECT_EQ(toneOf(pixelOf(picture, picture.zooms[0], kInsideU, kInsideV)), Tone::kRed);
}

TEST_F(OverlayTest, ModelBehindTheDataIsBlue) {
  const OverlayPicture picture =
      drawOverlay(scan(mesh_, truth_, 500), {posed(mesh_, facing(0, 0, 330))});
  EXPECT_EQ(toneOf(pixelOf(picture, picture.overlay, kInsideU, kInsideV)), Tone::kBlue);
}

TEST(DifferenceColourTest, ChangesToneAtTheTolerance) {
  for (const double difference : {0.0, 1.9, -1.9}) {
    EXPECT_EQ(toneOf(differenceColour(difference, 2.0)), Tone::kGreen) << difference;
  }
  EXPECT_EQ(toneOf(differenceColour(2.1, 2.0)), Tone::kRed);
  EXPECT_NE(toneOf(differenceColour(-2.1, 2.0)), Tone::kGreen);
  EXPECT_EQ(toneOf(differenceColour(50.0, 2.0)), Tone::kRed);
  EXPECT_EQ(toneOf(differenceColour(-50.0, 2.0)), Tone::kBlue);
}

TEST_F(OverlayTest, SceneOutsideOfTheModelStaysGreyAndHolesAreNot) {
  DepthImage image = scan(mesh_, truth_, 500);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) image.depth_mm.at(x, y) = 0.0f;
  }
  const OverlayPicture picture = drawOverlay(image, {posed(mesh_, truth_)});
  for (const OverlayPanel& panel : {picture.relief, picture.overlay}) {
    EXPECT_EQ(toneOf(pixelOf(picture, panel, 20, 100)), Tone::kGrey);
    EXPECT_EQ(pixelOf(picture, panel, 8, 8), kHoleColour);
  }
  EXPECT_EQ(toneOf(pixelOf(picture, picture.relief, kInsideU, kInsideV)), Tone::kGrey)
      << "the bare view shows no model";
}

TEST_F(OverlayTest, ModelOverMissingDataIsNeitherGreenNorRed) {
  DepthImage image = scan(mesh_, truth_, 500);
  for (int y = 45; y < 75; ++y) {
    for (int x = 60; x < 100; ++x) image.depth_mm.at(x, y) = 0.0f;
  }
  const OverlayPicture picture = drawOverlay(image, {posed(mesh_, truth_)});
  const cv::Vec3b pixel = pixelOf(picture, picture.overlay, kInsideU, kInsideV);
  EXPECT_GT(pixel[0], pixel[1]);
  EXPECT_GT(pixel[2], pixel[1]);
  EXPECT_NE(pixel, kHoleColour);
}

TEST_F(OverlayTest, OutlineLiesOnTheBorderOfTheModel) {
  const OverlayPicture picture = drawOverlay(scan(mesh_, truth_, 500), {posed(mesh_, truth_)});
  // The front face reaches from u = 64.0 to 95.0: look for the line's yellow along a row of the
  // zoom.
  const OverlayPanel& zoom = picture.zooms[0];
  const int row = zoom.box.y + static_cast<int>((kInsideV - zoom.source.y0 + 0.5) * zoom.scale);
  std::vector<double> found;
  for (int x = zoom.box.x; x < zoom.box.x + zoom.box.width; ++x) {
    const cv::Vec3b pixel = picture.image.at<cv::Vec3b>(row, x);
    if (pixel[2] > 220 && pixel[1] > 190 && pixel[0] < 90) {
      found.push_back(zoom.source.x0 - 0.5 + (x - zoom.box.x + 0.5) / zoom.scale);
    }
  }
  ASSERT_GE(found.size(), 2U);
  EXPECT_NEAR(found.front(), 79.5 - 30.0 / 290.0 * 150.0, 0.5);
  EXPECT_NEAR(found.back(), 79.5 + 30.0 / 290.0 * 150.0, 0.5);
  EXPECT_LT(found.size(), 12U) << "a line, not an area";
}

TEST_F(OverlayTest, CreasesOfATiltedBoxAreDrawn) {
  Pose tilted = truth_;
  tilted.rotation = rotationFromVector({0.0, 0.8, 0.0});
  const OverlayPicture picture = drawOverlay(scan(mesh_, tilted, 500), {posed(mesh_, tilted)});
  const OverlayPanel& zoom = picture.zooms[0];
  // The edge between two faces: the corner (x, z) = (30, -10) or (-30, -10) nearest to the camera.
  const glm::dvec3 left = tilted * glm::dvec3(-30, 10, -10);
  const glm::dvec3 right = tilted * glm::dvec3(30, 10, -10);
  const glm::dvec2 crease = testing::smallCamera().project(left.z < right.z ? left : right);
  const int row = zoom.box.y + static_cast<int>((crease.y - zoom.source.y0 + 0.5) * zoom.scale);
  const int column = zoom.box.x + static_cast<int>((crease.x - zoom.source.x0 + 0.5) * zoom.scale);
  int darkest = 255;
  for (int x = column - 4; x <= column + 4; ++x) {
    darkest = std::min<int>(darkest, picture.image.at<cv::Vec3b>(row, x)[1]);
  }
  const int face = picture.image.at<cv::Vec3b>(row, column + (left.z < right.z ? 30 : -30))[1];
  EXPECT_LT(darkest, face * 3 / 4);
}

TEST_F(OverlayTest, EnlargedSlopesThatAgreeAreGreenAllOver) {
  Pose tilted = truth_;
  tilted.rotation = rotationFromVector({0.6, 0.7, 0.0});
  const OverlayPicture picture = drawOverlay(scan(mesh_, tilted, 500), {posed(mesh_, tilted)});
  const OverlayPanel& zoom = picture.zooms[0];
  int red_or_blue = 0;
  int green = 0;
  for (int y = zoom.box.y; y < zoom.box.y + zoom.box.height; ++y) {
    for (int x = zoom.box.x; x < zoom.box.x + zoom.box.width; ++x) {
      const Tone tone = toneOf(picture.image.at<cv::Vec3b>(y, x));
      green += tone == Tone::kGreen ? 1 : 0;
      red_or_blue += tone == Tone::kRed || tone == Tone::kBlue ? 1 : 0;
    }
  }
  EXPECT_GT(green, 10000);
  EXPECT_LT(red_or_blue, green / 25) << "axes and pixels of the outline aside, nothing differs";
}

TEST_F(OverlayTest, AgreementCountsEachPixelOnce) {
  DepthImage image = scan(mesh_, truth_, 500);
  for (int y = 0; y < image.depth_mm.height(); ++y) {
    for (int x = 0; x < image.depth_mm.width(); ++x) {
      float& z = image.depth_mm.at(x, y);
      if (x < 70) z = 0.0f;
      if (x >= 70 && x < 75) z = 200.0f;
      if (x >= 75 && x < 80) z = 400.0f;
    }
  }
  const Agreement result = agreementOf(image, posed(mesh_, truth_), 2.0);
  const int rows =
      21;  // 38.8 .. 59.5 +- 10.3 px about row 59.5, of which 20 or 21 centres are covered
  EXPECT_GT(result.missing_px, 0);
  EXPECT_NEAR(result.hidden_px, 5 * rows, 5);
  EXPECT_NEAR(result.in_front_px, 5 * rows, 5);
  EXPECT_NEAR(result.agrees_px, 15 * rows, 25);
  EXPECT_EQ(result.model_px,
            result.missing_px + result.hidden_px + result.in_front_px + result.agrees_px);
}

TEST_F(OverlayTest, PictureIsWideEnoughAndFirstPoseIsMagnified) {
  const OverlayPicture picture = drawOverlay(scan(mesh_, truth_, 500), {posed(mesh_, truth_)});
  EXPECT_GE(picture.image.cols, 1200);
  EXPECT_GE(picture.zooms[0].scale, 3.0);
  const cv::Rect page(0, 0, picture.image.cols, picture.image.rows);
  for (const OverlayPanel& panel : {picture.relief, picture.overlay, picture.zooms[0]}) {
    EXPECT_EQ(panel.box & page, panel.box);
  }
}

TEST_F(OverlayTest, WithoutPosesTheDepthImageIsStillShown) {
  const OverlayPicture picture = drawOverlay(scan(mesh_, truth_, 500), {});
  EXPECT_GE(picture.image.cols, 1200);
  EXPECT_TRUE(picture.zooms.empty());
}

TEST_F(OverlayTest, PoseOutsideOfTheImageOrBehindTheCameraIsReportedNotDrawn) {
  const DepthImage image = scan(mesh_, truth_, 500);
  for (const Pose& pose : {facing(5000, 0, 300), facing(0, 0, -300)}) {
    const OverlayPicture picture = drawOverlay(image, {posed(mesh_, pose)});
    ASSERT_EQ(picture.zooms.size(), 1U);
    EXPECT_TRUE(picture.zooms[0].box.empty());
    EXPECT_EQ(picture.agreement[0].model_px, 0);
  }
}

TEST_F(OverlayTest, AnEmptyDepthImageIsNoReasonToFail) {
  const DepthImage image{testing::smallCamera(), Image<float>(160, 120, 0.0f)};
  const OverlayPicture picture = drawOverlay(image, {posed(mesh_, truth_)});
  EXPECT_EQ(picture.agreement[0].missing_px, picture.agreement[0].model_px);
}

TEST_F(OverlayTest, OrthographicScansAreDrawnAlike) {
  DepthImage image;
  image.camera.width = 100;
  image.camera.height = 80;
  image.camera.orthographic = true;
  image.camera.pixel_size_mm = 1.0;
  image.camera.cx = 49.5;
  image.camera.cy = 39.5;
  image.depth_mm = Image<float>(100, 80, 500.0f);
  for (int y = 20; y < 60; ++y) {
    for (int x = 20; x < 80; ++x) image.depth_mm.at(x, y) = 290.0f;
  }
  const OverlayPicture picture = drawOverlay(image, {posed(mesh_, truth_)});
  EXPECT_EQ(picture.agreement[0].agrees_px, 60 * 40);
  EXPECT_EQ(toneOf(pixelOf(picture, picture.overlay, 30, 25)), Tone::kGreen);
}

TEST_F(OverlayTest, SmallestModelSetsTheTolerance) {
  const Mesh small = box(3, 4, 12);  // diameter 13
  const OverlayPicture picture = drawOverlay(
      scan(mesh_, truth_, 500), {posed(mesh_, truth_), posed(small, facing(40, 0, 300))});
  EXPECT_NEAR(picture.tolerance_mm, kToleranceShare * 13.0, 1e-9);
  EXPECT_EQ(drawOverlay(scan(mesh_, truth_, 500), {posed(mesh_, truth_)}, {4.5, 1}).tolerance_mm,
            4.5);
}

TEST_F(OverlayTest, MissingMeshAndWrongSizeAreErrors) {
  DepthImage image = scan(mesh_, truth_, 500);
  EXPECT_THROW(drawOverlay(image, {OverlayPose{}}), Error);
  image.camera.width = 161;
  EXPECT_THROW(drawOverlay(image, {}), Error);
}

TEST_F(OverlayTest, FileHoldsThePicture) {
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / "overlay_test.png";
  const DepthImage image = scan(mesh_, truth_, 500);
  writeOverlay(file, image, {posed(mesh_, truth_)});
  const cv::Mat read = cv::imread(file.string(), cv::IMREAD_COLOR);
  const cv::Mat drawn = drawOverlay(image, {posed(mesh_, truth_)}).image;
  ASSERT_EQ(read.size(), drawn.size());
  EXPECT_EQ(cv::norm(read, drawn, cv::NORM_INF), 0.0);
  std::filesystem::remove(file);
}

TEST(ReliefTest, FacesTowardsTheLightAreBrighter) {
  // Two planes that meet in the middle: the left one looks to the left, where the light is.
  DepthImage image{testing::smallCamera(), Image<float>(160, 120)};
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      image.depth_mm.at(x, y) = 400.0f + 1.5f * std::abs(static_cast<float>(x) - 79.5f);
    }
  }
  const cv::Mat pixels = relief(image);
  EXPECT_GT(pixels.at<cv::Vec3b>(60, 40)[0], pixels.at<cv::Vec3b>(60, 120)[0] + 40);
}

TEST(ReliefTest, ViewsFindTheDepthPixelUnderAPicturePixel) {
  for (const double scale : {3.0, 1.7, 0.5}) {
    const PictureView view = pictureView({10, 20, 60, 50}, scale);
    for (int u = 10; u < 60; u += 7) {
      const cv::Point2d at = view.pictureFrom(u, 30);
      EXPECT_LE(std::abs(view.sourceX(static_cast<int>(std::lround(at.x))) - u),
                scale < 1.0 ? 1 : 0)
          << scale;
    }
    const Camera camera = view.camera(testing::smallCamera());
    const glm::dvec3 point(12, -7, 350);
    const glm::dvec2 pixel = testing::smallCamera().project(point);
    const cv::Point2d expected = view.pictureFrom(pixel.x, pixel.y);
    EXPECT_NEAR(camera.project(point).x, expected.x, 1e-9);
    EXPECT_NEAR(camera.project(point).y, expected.y, 1e-9);
  }
}

}  // namespace
}  // namespace rangepose::debug
