#include "sim/matching.h"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace rangepose {
namespace {

constexpr int kSpeckleRange = 1;  // disparities of a patch differ by less from pixel to pixel [px]

cv::Ptr<cv::StereoSGBM> semiGlobal(const MatchingSensor& sensor) {
  constexpr double kSmallStep = 8.0;   // penalties of OpenCV's own example, per pixel of a window
  constexpr double kLargeStep = 32.0;  // likewise
  const int area = sensor.window_px * sensor.window_px;
  return cv::StereoSGBM::create(sensor.columns * sensor.least_disparity_px,
                                sensor.columns * sensor.disparities,
                                sensor.window_px,
                                static_cast<int>(kSmallStep * sensor.smoothness * area),
                                static_cast<int>(kLargeStep * sensor.smoothness * area),
                                sensor.agreement_px,
                                31,
                                sensor.uniqueness_percent,
                                sensor.speckle_px,
                                kSpeckleRange,
                                cv::StereoSGBM::MODE_SGBM_3WAY);
}

/// Mean and deviation of grey values around each pixel.
struct Contrast {
  cv::Mat mean;
  cv::Mat deviation;

  Contrast(const cv::Mat& image, int width_px) {
    const cv::Size window(width_px, width_px);
    cv::Mat mean_square;
    cv::boxFilter(image, mean, CV_32F, window);
    cv::sqrBoxFilter(image, mean_square, CV_32F, window);
    cv::sqrt(cv::max(mean_square - mean.mul(mean), 0.0), deviation);
  }
};

/// Contrast that does not depend on how well a surface is lit: the stored pattern has no shades.
cv::Mat evenlyLit(const cv::Mat& image, int window_px) {
  constexpr double kMiddle = 128.0;
  constexpr double kContrast = 48.0;
  constexpr double kLeastDeviation = 4.0;  // of grey values; less is noise
  const Contrast around(image, 2 * window_px + 1);
  cv::Mat values;
  image.convertTo(values, CV_32F);
  cv::Mat result;
  cv::Mat((values - around.mean) / cv::max(around.deviation, kLeastDeviation) * kContrast + kMiddle)
      .convertTo(result, CV_8U);
  return result;
}

/// The same pixels, not copied; OpenCV only reads them.
cv::Mat wrap(const Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.data())};
}

}  // namespace

Image<float> matchedDisparity(const Image<std::uint8_t>& left,
                              const Image<std::uint8_t>& right,
                              const MatchingSensor& sensor,
                              SensorKind kind) {
  cv::Mat images[2] = {wrap(left), wrap(right)};
  const cv::Mat contrast = Contrast(images[0], sensor.window_px).deviation;
  if (kind == SensorKind::kSpeckle) {
    for (cv::Mat& image : images) image = evenlyLit(image, sensor.window_px);
  }
  // OpenCV leaves out what could reach beyond the left border; here it may look there.
  const int beside_px = sensor.least_disparity_px + sensor.disparities;
  for (cv::Mat& image : images) {
    const int missing_px = left.width() + beside_px - image.cols;
    cv::copyMakeBorder(image, image, 0, 0, missing_px, 0, cv::BORDER_CONSTANT);
    const cv::Size fine(sensor.columns * image.cols, image.rows);
    cv::resize(image, image, fine, 0.0, 0.0, cv::INTER_CUBIC);
  }
  cv::Mat found;
  semiGlobal(sensor)->compute(images[0], images[1], found);
  found = found.colRange(sensor.columns * beside_px, found.cols);
  Image<float> disparity(left.width(), left.height(), 0.0f);
  const int scale = cv::StereoMatcher::DISP_SCALE * sensor.columns;
  const int least = sensor.least_disparity_px * scale;
  for (int v = 0; v < left.height(); ++v) {
    const auto* const row = found.ptr<std::int16_t>(v);
    for (int u = 0; u < left.width(); ++u) {
      const int steps = row[sensor.columns * u];
      if (steps < least || steps <= 0 || contrast.at<float>(v, u) < sensor.least_contrast) {
        continue;
      }
      const double px = static_cast<double>(steps) / scale;
      disparity.at(u, v) =
          static_cast<float>(std::round(px / sensor.disparity_step) * sensor.disparity_step);
    }
  }
  return disparity;
}

}  // namespace rangepose
