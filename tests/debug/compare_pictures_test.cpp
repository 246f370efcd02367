#include "debug/compare_pictures.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "debug/canvas.h"

namespace rangepose::debug {
namespace {

using Kind = ComparedStage::Kind;

Image<float> ramp(int width, int height) {
  Image<float> image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = 1.0f + static_cast<float>(i);
  return image;
}

/// Pixels that are clearly red or blue: a difference of any sign.
int coloured(const cv::Mat& picture) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b& p = picture.at<cv::Vec3b>(y, x);
      count += std::abs(p[0] - p[2]) > 100 ? 1 : 0;
    }
  }
  return count;
}

TEST(ComparePictureTest, CountsPixelsThatAreNotEqual) {
  Image<float> subject = ramp(5, 3);
  subject.at(2, 1) += 0.5f;
  subject.at(4, 2) -= 2.0f;
  const Difference difference = differenceOf(ramp(5, 3), subject);
  EXPECT_EQ(difference.pixels, 2U);
  EXPECT_EQ(difference.all, 15U);
  EXPECT_DOUBLE_EQ(difference.largest, 2.0);
}

TEST(ComparePictureTest, TwoMissingValuesAreEqual) {
  const Image<float> missing(2, 2, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(differenceOf(missing, missing).pixels, 0U);
  EXPECT_EQ(differenceOf(missing, ramp(2, 2)).pixels, 4U);
}

TEST(ComparePictureTest, AnotherSizeDiffersEverywhere) {
  EXPECT_EQ(differenceOf(ramp(4, 4), ramp(5, 4)).pixels, 20U);
}

TEST(ComparePictureTest, OnlyADifferenceHasAColourInItsPanel) {
  // Labels: the difference is the only panel whose colours go from blue to red.
  const Image<float> labels(24, 24, -1.0f);
  Image<float> other = labels;
  const cv::Mat same =
      comparisonPicture({"host", "glsl"}, {{"patches", "", Kind::kLabels, {labels, other}}});
  other.at(3, 4) = 7.0f;
  const cv::Mat differs =
      comparisonPicture({"host", "glsl"}, {{"patches", "", Kind::kLabels, {labels, other}}});
  EXPECT_GT(coloured(differs), coloured(same));
}

TEST(ComparePictureTest, HasAColumnForEachPathAndADifferenceForEachSubject) {
  const Image<float> image = ramp(16, 16);
  const ComparedStage two{"range", "px", Kind::kPositive, {image, image}};
  const ComparedStage three{"range", "px", Kind::kPositive, {image, image, image}};
  const int width_of_two = comparisonPicture({"host", "glsl"}, {two}).cols;
  const int width_of_three = comparisonPicture({"host", "glsl", "cuda"}, {three}).cols;
  // 3 panels and 5 panels.
  EXPECT_GT(width_of_three, width_of_two * 3 / 2);
  EXPECT_THROW(comparisonPicture({"host"}, {two}), Error);
}

}  // namespace
}  // namespace rangepose::debug
