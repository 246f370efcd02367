// The image stages against OpenCV: a second opinion from code that many people use.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "stages/channels_host.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::awkwardScenes;
using test::RangeScene;

cv::Mat1f matOf(const Image<float>& image) {
  cv::Mat1f mat(image.height(), image.width());
  std::copy(image.begin(), image.end(), mat.begin());
  return mat;
}

TEST(OpenCvTest, MedianIsMedianBlur) {
  for (const RangeScene& scene : awkwardScenes()) {
    cv::Mat1f expected;
    cv::medianBlur(matOf(scene.range_px), expected, 3);
    const Image<float> actual = host::median(scene.range_px);
    EXPECT_TRUE(std::equal(actual.begin(), actual.end(), expected.begin())) << scene.name;
  }
}

TEST(OpenCvTest, DistanceIsDistanceTransform) {
  // See DistanceTest for the reason of the tolerance.
  constexpr double kPropagationPx = 0.3;
  constexpr int kPasses = 11;
  int reached = 0;
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host::edges(scene.range_px, 2.56f);
    cv::Mat1b far(edges.height(), edges.width());
    std::transform(edges.begin(), edges.end(), far.begin(), [](float edge) {
      return static_cast<unsigned char>(edge == 0.0f ? 1 : 0);
    });
    if (cv::countNonZero(far) == static_cast<int>(far.total()))
      continue;  // no edge: undefined there
    cv::Mat1f exact;
    cv::distanceTransform(far, exact, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    const Image<float> actual = host::distance(scene.range_px, edges, kPasses);
    for (int y = 0; y < edges.height(); ++y) {
      for (int x = 0; x < edges.width(); ++x) {
        const float expected = std::min(static_cast<float>(kPasses + 1), exact(y, x));
        ASSERT_GE(std::abs(actual.at(x, y)), expected - 1e-3f) << scene.name;
        ASSERT_LE(std::abs(actual.at(x, y)), expected + kPropagationPx) << scene.name;
        ++reached;
      }
    }
  }
  EXPECT_GT(reached, 50000);
}

TEST(OpenCvTest, PatchesAreConnectedComponents) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host::edges(scene.range_px, 2.56f);
    const Image<std::int32_t> labels = host::patches(scene.range_px, edges);
    cv::Mat1b inside(edges.height(), edges.width());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      inside.data[i] = scene.range_px.data()[i] != 0.0f && edges.data()[i] == 0.0f ? 1 : 0;
    }
    cv::Mat1i expected;
    const int components = cv::connectedComponents(inside, expected, 4, CV_32S);
    std::map<int, int> theirs_to_ours;
    std::map<int, int> ours_to_theirs;
    for (int y = 0; y < edges.height(); ++y) {
      for (int x = 0; x < edges.width(); ++x) {
        const int ours = labels.at(x, y);
        const int theirs = expected(y, x);
        ASSERT_EQ(ours == kNoPatch, theirs == 0) << scene.name;
        ASSERT_EQ(theirs_to_ours.emplace(theirs, ours).first->second, ours) << scene.name;
        ASSERT_EQ(ours_to_theirs.emplace(ours, theirs).first->second, theirs) << scene.name;
      }
    }
    const int background =
        inside.total() > static_cast<std::size_t>(cv::countNonZero(inside)) ? 1 : 0;
    EXPECT_EQ(static_cast<int>(ours_to_theirs.size()), components - 1 + background) << scene.name;
  }
}

}  // namespace
}  // namespace rangepose
