#include "debug/overlay_legend.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "debug/canvas.h"
#include "debug/relief.h"

namespace rangepose::debug {
namespace {

constexpr double kFullColourTolerances =
    3.0;  // differences of so many tolerances are full red or blue

cv::Vec3b mixed(const cv::Vec3d& a, const cv::Vec3d& b, double share) {
  return cv::Vec3b((1.0 - share) * a + share * b);
}

/// The colours of the difference with its values [mm] below.
cv::Mat differenceLegend(double tolerance_mm) {
  constexpr int kWidth = 560;
  constexpr int kInset = 30;
  constexpr double kReach = kFullColourTolerances + 1.0;
  cv::Mat legend(66, kWidth + 2 * kInset, CV_8UC3, kPaper);
  drawText(legend, {0, 0}, "scene depth - model depth [mm]");
  for (int x = 0; x < kWidth; ++x) {
    const double t = kReach * (2.0 * x / (kWidth - 1) - 1.0);
    legend(cv::Rect(kInset + x, 20, 1, 16))
        .setTo(cv::Scalar(differenceColour(t * tolerance_mm, tolerance_mm)));
  }
  for (const double t : {-3.0, -1.0, 0.0, 1.0, 3.0}) {
    const int x = kInset + static_cast<int>(std::lround((t / kReach + 1.0) / 2.0 * (kWidth - 1)));
    cv::line(legend, {x, 36}, {x, 40}, kInk);
    const std::string text = number(t * tolerance_mm, decimalsFor(tolerance_mm / 10.0));
    drawText(legend, {x - textSize(text, kTextPx - 1).width / 2, 45}, text, kInk, kTextPx - 1);
  }
  return legend;
}

cv::Mat swatch(const cv::Scalar& colour, const std::string& text) {
  const cv::Size size = textSize(text);
  cv::Mat entry(18, 30 + size.width, CV_8UC3, kPaper);
  entry(cv::Rect(0, 1, 22, 14)).setTo(colour);
  drawText(entry, {30, 2}, text);
  return entry;
}

}  // namespace

cv::Vec3b differenceColour(double difference_mm, double tolerance_mm) {
  const cv::Vec3d green(70, 190, 60);
  const double t = std::abs(difference_mm) / tolerance_mm;
  if (t <= 1.0) return cv::Vec3b(green);
  const double share = std::min(1.0, (t - 1.0) / (kFullColourTolerances - 1.0));
  if (difference_mm > 0.0) return mixed({30, 160, 245}, {20, 20, 215}, share);
  return mixed({215, 190, 40}, {230, 60, 30}, share);
}

cv::Mat overlayLegend(double tolerance_mm) {
  const auto of = [&](double t) {
    return cv::Scalar(differenceColour(t * tolerance_mm, tolerance_mm));
  };
  const cv::Mat meaning = below(
      {swatch(of(0.0),
              "agrees within " + number(tolerance_mm, decimalsFor(tolerance_mm / 10.0)) + " mm"),
       swatch(of(5.0), "model in front of the data (contradiction)"),
       swatch(of(-5.0), "model hidden behind the data")},
      4);
  const cv::Mat rest = below({swatch(kMissingTint, "model where nothing was measured"),
                              swatch(cv::Scalar(kHoleColour), "no measurement"),
                              swatch(kOutlineColour, "outline of the model")},
                             4);
  const cv::Mat axes = below({swatch(kAxisColours[0], "x axis"),
                              swatch(kAxisColours[1], "y axis"),
                              swatch(kAxisColours[2], "z axis")},
                             4);
  return beside({differenceLegend(tolerance_mm), meaning, rest, axes}, 2 * kGapPx);
}

}  // namespace rangepose::debug
