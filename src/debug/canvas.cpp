#include "debug/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "io/atomic_file.h"

namespace rangepose::debug {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontCapitalPx = 22.0;  // height of a capital at scale 1

double fontScale(int capital_px) { return capital_px / kFontCapitalPx; }

int fontThickness(int capital_px) { return capital_px >= 16 ? 2 : 1; }

int platePad(int capital_px) { return std::max(2, capital_px / 3); }

}  // namespace

cv::Size textSize(const std::string& text, int capital_px) {
  int baseline = 0;
  const cv::Size size =
      cv::getTextSize(text, kFont, fontScale(capital_px), fontThickness(capital_px), &baseline);
  return {size.width + 2, capital_px + capital_px / 3 + 1};
}

void drawText(cv::Mat& canvas,
              cv::Point top_left,
              const std::string& text,
              const cv::Scalar& colour,
              int capital_px) {
  const cv::Point base_line(top_left.x, top_left.y + capital_px);
  cv::putText(canvas,
              text,
              base_line,
              kFont,
              fontScale(capital_px),
              colour,
              fontThickness(capital_px),
              cv::LINE_AA);
}

cv::Rect plateOf(cv::Size canvas, cv::Point top_left, const std::string& text, int capital_px) {
  const int pad = platePad(capital_px);
  cv::Rect plate(
      top_left.x, top_left.y, textSize(text, capital_px).width + 2 * pad, capital_px + 2 * pad);
  plate.x = std::max(0, std::min(plate.x, canvas.width - plate.width));
  plate.y = std::max(0, std::min(plate.y, canvas.height - plate.height));
  return plate;
}

void drawPlate(cv::Mat& canvas,
               cv::Point top_left,
               const std::string& text,
               const cv::Scalar& colour,
               int capital_px) {
  const cv::Rect plate = plateOf(canvas.size(), top_left, text, capital_px);
  cv::Mat under = canvas(plate & cv::Rect(0, 0, canvas.cols, canvas.rows));
  under *= 0.3;
  const int pad = platePad(capital_px);
  drawText(canvas, {plate.x + pad, plate.y + pad}, text, colour, capital_px);
}

cv::Mat beside(const std::vector<cv::Mat>& panels, int gap_px) {
  int width = 0;
  int height = 0;
  for (const cv::Mat& panel : panels) {
    if (panel.empty()) continue;
    width += panel.cols + (width > 0 ? gap_px : 0);
    height = std::max(height, panel.rows);
  }
  cv::Mat page(height, width, CV_8UC3, kPaper);
  int x = 0;
  for (const cv::Mat& panel : panels) {
    if (panel.empty()) continue;
    panel.copyTo(page(cv::Rect(x, 0, panel.cols, panel.rows)));
    x += panel.cols + gap_px;
  }
  return page;
}

cv::Mat below(const std::vector<cv::Mat>& panels, int gap_px) {
  int width = 0;
  int height = 0;
  for (const cv::Mat& panel : panels) {
    if (panel.empty()) continue;
    height += panel.rows + (height > 0 ? gap_px : 0);
    width = std::max(width, panel.cols);
  }
  cv::Mat page(height, width, CV_8UC3, kPaper);
  int y = 0;
  for (const cv::Mat& panel : panels) {
    if (panel.empty()) continue;
    panel.copyTo(page(cv::Rect(0, y, panel.cols, panel.rows)));
    y += panel.rows + gap_px;
  }
  return page;
}

cv::Mat titled(const cv::Mat& panel, const std::string& title, const std::string& note) {
  const auto line = [](const std::string& text, const cv::Scalar& colour, int capital_px) {
    if (text.empty()) return cv::Mat();
    const cv::Size size = textSize(text, capital_px);
    cv::Mat strip(size.height, size.width, CV_8UC3, kPaper);
    drawText(strip, {0, 0}, text, colour, capital_px);
    return strip;
  };
  return below({line(title, kInk, kTextPx + 1), line(note, kFaintInk, kTextPx - 1), panel}, 6);
}

cv::Mat framed(const cv::Mat& panel, int margin_px) {
  cv::Mat page;
  cv::copyMakeBorder(
      panel, page, margin_px, margin_px, margin_px, margin_px, cv::BORDER_CONSTANT, kPaper);
  return page;
}

cv::Mat enlarged(const cv::Mat& pixels, int factor) {
  if (factor <= 1) return pixels.clone();
  cv::Mat larger;
  cv::resize(pixels, larger, {}, factor, factor, cv::INTER_NEAREST);
  return larger;
}

int enlargement(int width, int height, int target_px) {
  const int side = std::max({width, height, 1});
  return std::max(1, target_px / side);
}

std::string number(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

int decimalsFor(double step) {
  if (!(step > 0.0)) return 0;
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
}

std::vector<double> roundTicks(double low, double high, int count) {
  std::vector<double> ticks;
  if (!(high > low) || count < 1) return ticks;
  const double raw = (high - low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw) step = factor * power;
  }
  const auto first = static_cast<long long>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<long long>(std::floor(high / step + 1e-9));
  for (long long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

std::string sizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height) + " px";
}

void writePng(const std::filesystem::path& file, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  bool encoded = false;
  try {
    encoded = cv::imencode(".png", picture, bytes);
  } catch (const cv::Exception& failure) {
    throw Error("cannot encode picture " + file.string() + ": " + failure.err);
  }
  if (!encoded) throw Error("cannot encode picture " + file.string() + "; OpenCV lacks PNG");
  writeFileAtomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace rangepose::debug
