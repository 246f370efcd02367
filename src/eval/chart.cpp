#include "eval/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "debug/canvas.h"

namespace rangepose {
namespace {

using debug::drawText;
using debug::kTextPx;
using debug::textSize;

constexpr int kWidth = 640;
constexpr int kHeight = 420;
constexpr int kLeft = 70;
constexpr int kTop = 30;
constexpr int kBottom = 56;
constexpr int kLegend = 230;
constexpr int kLegendLine = 22;
constexpr int kSmallTextPx = kTextPx - 1;
constexpr int kFraction = 4;  ///< curves are drawn to 1/16 px

/// Told apart by people who do not see all colours (after Okabe and Ito), blue first (BGR).
const std::array<cv::Scalar, 7> kColours = {cv::Scalar(178, 114, 0),
                                            cv::Scalar(0, 94, 213),
                                            cv::Scalar(115, 158, 0),
                                            cv::Scalar(167, 121, 204),
                                            cv::Scalar(0, 159, 230),
                                            cv::Scalar(233, 180, 86),
                                            cv::Scalar(60, 60, 60)};

const cv::Scalar& colourOf(std::size_t curve) { return kColours[curve % kColours.size()]; }

class Axes {
 public:
  Axes(const ChartAxis& x, const ChartAxis& y) : x_(x), y_(y) {
    RP_CHECK(x.high > x.low && y.high > y.low, "chart: an axis has no extent");
  }
  cv::Point2d at(double x, double y) const {
    return {kLeft + (x - x_.low) / (x_.high - x_.low) * kWidth,
            kTop + (1.0 - (y - y_.low) / (y_.high - y_.low)) * kHeight};
  }

  void draw(cv::Mat& page) const {
    const std::vector<double> rows = debug::roundTicks(y_.low, y_.high, 6);
    for (const double value : rows) {
      const int row = cvRound(at(x_.low, value).y);
      cv::line(page, {kLeft, row}, {kLeft + kWidth, row}, debug::kRule);
      const std::string text = debug::number(value, decimalsOf(rows));
      drawText(page,
               {kLeft - 8 - textSize(text, kSmallTextPx).width, row - kSmallTextPx / 2},
               text,
               debug::kInk,
               kSmallTextPx);
    }
    const std::vector<double> columns = debug::roundTicks(x_.low, x_.high, 8);
    for (const double value : columns) {
      const int column = cvRound(at(value, y_.low).x);
      cv::line(page, {column, kTop + kHeight}, {column, kTop + kHeight + 4}, debug::kInk);
      const std::string text = debug::number(value, decimalsOf(columns));
      const int half = textSize(text, kSmallTextPx).width / 2;
      drawText(page, {column - half, kTop + kHeight + 9}, text, debug::kInk, kSmallTextPx);
    }
    cv::rectangle(page, cv::Rect(kLeft, kTop, kWidth + 1, kHeight + 1), debug::kFaintInk);
    const int label_width = textSize(x_.label, kSmallTextPx).width;
    drawText(page,
             {kLeft + kWidth - label_width, kTop + kHeight + 32},
             x_.label,
             debug::kFaintInk,
             kSmallTextPx);
    drawText(page, {kLeft, 8}, y_.label, debug::kFaintInk, kSmallTextPx);
  }

 private:
  static int decimalsOf(const std::vector<double>& ticks) {
    return ticks.size() > 1 ? debug::decimalsFor(ticks[1] - ticks[0]) : 1;
  }
  ChartAxis x_;
  ChartAxis y_;
};

cv::Point fine(const cv::Point2d& point) {
  constexpr double kUnits = 1 << kFraction;
  return {cvRound(point.x * kUnits), cvRound(point.y * kUnits)};
}

void drawCurve(cv::Mat& page, const Axes& axes, const ChartCurve& curve, const cv::Scalar& colour) {
  std::vector<cv::Point> line;
  for (const cv::Point2d& point : curve.points) {
    if (std::isfinite(point.x) && std::isfinite(point.y))
      line.push_back(fine(axes.at(point.x, point.y)));
  }
  // What lies outside of the axes is cut off by drawing into the plot alone.
  const cv::Rect plot(kLeft, kTop, kWidth + 1, kHeight + 1);
  cv::Mat inside = page(plot);
  for (cv::Point& point : line) point -= cv::Point(plot.x << kFraction, plot.y << kFraction);
  if (line.size() > 1) {
    cv::polylines(inside,
                  std::vector<std::vector<cv::Point>>{line},
                  false,
                  colour,
                  2,
                  cv::LINE_AA,
                  kFraction);
  }
  if (!curve.dots && line.size() > 1) return;
  for (const cv::Point& point : line) {
    cv::circle(inside, point, 4 << kFraction, colour, cv::FILLED, cv::LINE_AA, kFraction);
  }
}

void drawLegend(cv::Mat& page, const std::vector<ChartCurve>& curves) {
  const int x = kLeft + kWidth + 18;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const int y = kTop + 10 + kLegendLine * static_cast<int>(i);
    cv::line(page, {x, y}, {x + 22, y}, colourOf(i), 3, cv::LINE_AA);
    drawText(page, {x + 30, y - kSmallTextPx / 2}, curves[i].name, debug::kInk, kSmallTextPx);
  }
}

}  // namespace

cv::Mat drawChart(const Chart& chart) {
  const Axes axes(chart.x, chart.y);
  const int legend_height = kTop + kLegendLine * static_cast<int>(chart.curves.size()) + 10;
  cv::Mat page(std::max(kTop + kHeight + kBottom, legend_height),
               kLeft + kWidth + kLegend,
               CV_8UC3,
               debug::kPaper);
  axes.draw(page);
  if (chart.diagonal) {
    cv::line(page,
             axes.at(chart.x.low, chart.y.low),
             axes.at(chart.x.high, chart.y.high),
             debug::kRule,
             1,
             cv::LINE_AA);
  }
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    drawCurve(page, axes, chart.curves[i], colourOf(i));
  }
  drawLegend(page, chart.curves);
  return debug::framed(debug::titled(page, chart.title, chart.note));
}

}  // namespace rangepose
