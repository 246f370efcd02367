#include "eval/stacked_bars.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "debug/canvas.h"

namespace rangepose {
namespace {

using debug::drawText;
using debug::kTextPx;
using debug::textSize;

constexpr int kWidth = 620;
constexpr int kBarHeight = 26;
constexpr int kBarPitch = 38;
constexpr int kTop = 8;
constexpr int kNames = 300;
constexpr int kTotals = 110;
constexpr int kLegendLine = 22;
constexpr int kSmallTextPx = kTextPx - 1;

const std::array<cv::Scalar, 8> kColours = {cv::Scalar(178, 114, 0),
                                            cv::Scalar(233, 180, 86),
                                            cv::Scalar(115, 158, 0),
                                            cv::Scalar(66, 228, 240),
                                            cv::Scalar(0, 159, 230),
                                            cv::Scalar(0, 94, 213),
                                            cv::Scalar(167, 121, 204),
                                            cv::Scalar(110, 110, 110)};

double totalOf(const StackedBars::Bar& bar) {
  return std::accumulate(bar.values.begin(), bar.values.end(), 0.0);
}

void drawBar(
    const StackedBars& chart, const StackedBars::Bar& bar, double scale, int y, cv::Mat& page) {
  drawText(page, {0, y + (kBarHeight - kSmallTextPx) / 2}, bar.name, debug::kInk, kSmallTextPx);
  double begin = 0.0;
  for (std::size_t i = 0; i < bar.values.size(); ++i) {
    const double end = begin + bar.values[i];
    const int x0 = kNames + cvRound(begin * scale);
    const int x1 = kNames + cvRound(end * scale);
    if (x1 > x0) {
      cv::rectangle(
          page, cv::Rect(x0, y, x1 - x0, kBarHeight), kColours[i % kColours.size()], cv::FILLED);
    }
    begin = end;
  }
  const std::string total = debug::number(begin, begin < 100.0 ? 1 : 0) + " " + chart.unit;
  drawText(page,
           {kNames + cvRound(begin * scale) + 8, y + (kBarHeight - kSmallTextPx) / 2},
           total,
           debug::kInk,
           kSmallTextPx);
}

cv::Mat legend(const StackedBars& chart) {
  cv::Mat page(kLegendLine * static_cast<int>(chart.parts.size()), 240, CV_8UC3, debug::kPaper);
  for (std::size_t i = 0; i < chart.parts.size(); ++i) {
    const int y = kLegendLine * static_cast<int>(i);
    cv::rectangle(page, cv::Rect(4, y + 4, 14, 14), kColours[i % kColours.size()], cv::FILLED);
    drawText(page, {26, y + 5}, chart.parts[i], debug::kInk, kSmallTextPx);
  }
  return page;
}

}  // namespace

cv::Mat drawStackedBars(const StackedBars& chart) {
  double longest = 0.0;
  for (const StackedBars::Bar& bar : chart.bars) {
    RP_CHECK(bar.values.size() == chart.parts.size(), "bars: " + bar.name + " lacks a value");
    longest = std::max(longest, totalOf(bar));
  }
  const double scale = longest > 0.0 ? kWidth / longest : 0.0;
  cv::Mat page(2 * kTop + kBarPitch * static_cast<int>(chart.bars.size()),
               kNames + kWidth + kTotals,
               CV_8UC3,
               debug::kPaper);
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    drawBar(chart, chart.bars[i], scale, kTop + kBarPitch * static_cast<int>(i), page);
  }
  return debug::framed(
      debug::titled(debug::beside({page, legend(chart)}), chart.title, chart.note));
}

}  // namespace rangepose
