#include "debug/statistics_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/pose.h"
#include "geometry/orientation_grid.h"

namespace rangepose::debug {
namespace {

glm::dmat3 about(int axis, double angle) {
  glm::dvec3 vector(0.0);
  vector[axis] = angle;
  return rotationFromVector(vector);
}

TEST(EulerAnglesTest, GiveTheRotationBack) {
  std::vector<glm::dmat3> rotations = uniformRotations(200);
  rotations.push_back(about(1, 0.5 * std::numbers::pi));
  rotations.push_back(about(2, 0.4) * about(1, -0.5 * std::numbers::pi) * about(0, 0.3));
  for (const glm::dmat3& rotation : rotations) {
    const glm::dvec3 angles = eulerAngles(rotation);
    const glm::dmat3 back = about(2, angles.z) * about(1, angles.y) * about(0, angles.x);
    EXPECT_LT(rotationAngleBetween(back, rotation), 1e-6);
    EXPECT_LE(std::abs(angles.y), 0.5 * std::numbers::pi);
  }
}

TEST(StatisticsPicturesTest, TheMapShowsWhereTheyLook) {
  // All look along +x of the object: azimuth 0, elevation 0, the middle of the map.
  const glm::dmat3 looking(glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0));
  const cv::Mat picture = sphericalPicture({looking, looking}, {});
  cv::Mat yellow;
  cv::inRange(picture(cv::Rect(0, 0, 960, picture.rows)),
              cv::Scalar(0, 200, 200),
              cv::Scalar(80, 255, 255),
              yellow);
  cv::Mat points;
  cv::findNonZero(yellow, points);
  ASSERT_GT(points.total(), 0u);
  const cv::Scalar mean = cv::mean(points);
  EXPECT_NEAR(mean[0], 480.0, 8.0);
  const cv::Rect box = cv::boundingRect(points);
  EXPECT_LT(box.width, 60);  // 5 degrees either way
}

TEST(StatisticsPicturesTest, ViewsAreDots) {
  const std::vector<glm::dmat3> rotations = uniformRotations(500);
  const cv::Mat without = sphericalPicture(rotations, {});
  const cv::Mat with = sphericalPicture(rotations, uniformRotations(20));
  cv::Mat difference;
  cv::absdiff(without, with, difference);
  EXPECT_GT(cv::sum(difference)[0], 0.0);
}

TEST(StatisticsPicturesTest, APageHasAllAndNothingIsRefused) {
  const cv::Mat page = statisticsPage("bolt", "20 bins", uniformRotations(300), {});
  EXPECT_GT(page.cols, 900);
  EXPECT_GT(page.rows, 700);
  EXPECT_THROW(eulerHistograms({}), Error);
  EXPECT_THROW(sphericalPicture({}, {}), Error);
}

}  // namespace
}  // namespace rangepose::debug
