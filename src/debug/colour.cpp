#include "debug/colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "debug/canvas.h"

namespace rangepose::debug {
namespace {

constexpr int kSteps = 256;
using Palette = std::array<cv::Vec3b, kSteps>;

Palette viridis() {
  cv::Mat ramp(1, kSteps, CV_8UC1);
  for (int i = 0; i < kSteps; ++i) ramp.at<unsigned char>(0, i) = static_cast<unsigned char>(i);
  cv::Mat colours;
  cv::applyColorMap(ramp, colours, cv::COLORMAP_VIRIDIS);
  Palette palette;
  for (int i = 0; i < kSteps; ++i)
    palette[static_cast<std::size_t>(i)] = colours.at<cv::Vec3b>(0, i);
  return palette;
}

Palette blueWhiteRed() {
  const cv::Vec3d blue(196, 86, 36);
  const cv::Vec3d white(242, 242, 242);
  const cv::Vec3d red(38, 22, 184);
  Palette palette;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 2.0 * i / (kSteps - 1) - 1.0;
    const cv::Vec3d colour = white + (std::abs(t)) * ((t < 0.0 ? blue : red) - white);
    for (int k = 0; k < 3; ++k) {
      palette[static_cast<std::size_t>(i)][k] = cv::saturate_cast<unsigned char>(colour[k]);
    }
  }
  return palette;
}

std::vector<float> presentValues(const Image<float>& values, bool zero_is_missing) {
  std::vector<float> present;
  present.reserve(values.size());
  for (const float value : values) {
    if (std::isfinite(value) && !(zero_is_missing && value == 0.0f)) present.push_back(value);
  }
  return present;
}

float quantile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::string unitText(const ColourScale& scale) {
  return scale.unit.empty() ? scale.name : scale.name + " [" + scale.unit + "]";
}

/// Writes the number of one tick beside the strip.
void drawTick(cv::Mat& bar, int y, const std::string& text) {
  cv::line(bar, {kBarStripPx, y}, {kBarStripPx + 4, y}, kInk, 1);
  drawText(bar, {kBarStripPx + 9, y - kTextPx / 2 + 1}, text, kInk, kTextPx - 1);
}

}  // namespace

ColourScale scaleOf(const Image<float>& values,
                    const std::string& name,
                    const std::string& unit,
                    bool zero_is_missing) {
  ColourScale scale{name, unit, 0.0f, 1.0f, zero_is_missing, false};
  std::vector<float> present = presentValues(values, zero_is_missing);
  if (present.empty()) return scale;
  scale.min = quantile(present, 0.005);
  scale.max = quantile(present, 0.995);
  if (!(scale.max > scale.min)) scale.max = scale.min + 1.0f;
  return scale;
}

ColourScale signedScaleOf(const Image<float>& values,
                          const std::string& name,
                          const std::string& unit,
                          bool zero_is_missing) {
  float reach = 0.0f;
  for (const float value : presentValues(values, zero_is_missing)) {
    reach = std::max(reach, std::abs(value));
  }
  if (reach == 0.0f) reach = 1.0f;
  return {name, unit, -reach, reach, zero_is_missing, true};
}

bool isMissing(float value, const ColourScale& scale) {
  return !std::isfinite(value) || (scale.zero_is_missing && value == 0.0f);
}

cv::Vec3b colourOf(float value, const ColourScale& scale) {
  static const Palette kViridis = viridis();
  static const Palette kBlueWhiteRed = blueWhiteRed();
  if (isMissing(value, scale)) return kMissingColour;
  const float span = scale.max > scale.min ? scale.max - scale.min : 1.0f;
  const float t = std::clamp((value - scale.min) / span, 0.0f, 1.0f);
  const auto index = static_cast<std::size_t>(std::lround(t * (kSteps - 1)));
  return scale.signed_field ? kBlueWhiteRed[index] : kViridis[index];
}

cv::Mat colourPixels(const Image<float>& values, const ColourScale& scale) {
  cv::Mat pixels(values.height(), values.width(), CV_8UC3);
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      pixels.at<cv::Vec3b>(y, x) = colourOf(values.at(x, y), scale);
    }
  }
  return pixels;
}

cv::Mat colourBar(const ColourScale& scale, int height) {
  const int strip = std::max(2, height - 2 * kBarMarginPx);
  const int rows = strip + 2 * kBarMarginPx;
  const double span = scale.max - scale.min;
  const std::vector<double> ticks = roundTicks(scale.min, scale.max, std::clamp(rows / 70, 1, 10));
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : span;
  const int decimals = decimalsFor(std::min(step, span / 10.0));
  const std::string ends[2] = {number(scale.max, decimals), number(scale.min, decimals)};
  const int numbers = std::max(textSize(ends[0]).width, textSize(ends[1]).width);
  const cv::Size name = textSize(unitText(scale), kTextPx - 1);
  cv::Mat bar(rows, kBarStripPx + 14 + numbers + 8 + name.height, CV_8UC3, kPaper);
  for (int i = 0; i < strip; ++i) {
    const double share = 1.0 - static_cast<double>(i) / (strip - 1);
    ColourScale all = scale;
    all.zero_is_missing = false;
    const cv::Vec3b colour = colourOf(static_cast<float>(scale.min + share * span), all);
    bar(cv::Rect(0, kBarMarginPx + i, kBarStripPx, 1)).setTo(cv::Scalar(colour));
  }
  const int top = kBarMarginPx;
  const int bottom = kBarMarginPx + strip - 1;
  drawTick(bar, top, ends[0]);
  drawTick(bar, bottom, ends[1]);
  for (const double tick : ticks) {
    const int y = bottom - static_cast<int>(std::lround((tick - scale.min) / span * (strip - 1)));
    if (y - top > 2 * kTextPx && bottom - y > 2 * kTextPx) drawTick(bar, y, number(tick, decimals));
  }
  cv::Mat title(name.height, name.width, CV_8UC3, kPaper);
  drawText(title, {0, 0}, unitText(scale), kFaintInk, kTextPx - 1);
  cv::rotate(title, title, cv::ROTATE_90_CLOCKWISE);
  const int shown = std::min(title.rows, rows);
  title(cv::Rect(0, 0, title.cols, shown))
      .copyTo(bar(cv::Rect(bar.cols - title.cols, (rows - shown) / 2, title.cols, shown)));
  return bar;
}

cv::Mat colourMap(const Image<float>& values, const ColourScale& scale, int target_px) {
  const int zoom = enlargement(values.width(), values.height(), target_px);
  const cv::Mat field = enlarged(colourPixels(values, scale), zoom);
  return beside({field, colourBar(scale, std::clamp(field.rows, 180, 600))});
}

cv::Vec3b labelColour(std::int32_t label) {
  if (label < 0) return kMissingColour;
  // Golden-angle steps of a scrambled label spread the hues; two levels of lightness double them.
  std::uint32_t mixed = static_cast<std::uint32_t>(label) * 2654435761u;
  mixed ^= mixed >> 15;
  const double hue = std::fmod(mixed * 0.61803398875, 1.0) * 6.0;
  const double value = (mixed >> 8 & 1u) != 0 ? 1.0 : 0.78;
  const double saturation = (mixed >> 9 & 1u) != 0 ? 0.85 : 0.6;
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    const double share = std::max(0.0, std::min({k, 4.0 - k, 1.0}));
    return cv::saturate_cast<unsigned char>(255.0 * value * (1.0 - saturation * share));
  };
  return {channel(1.0), channel(3.0), channel(5.0)};
}

cv::Mat labelPixels(const Image<std::int32_t>& labels) {
  cv::Mat pixels(labels.height(), labels.width(), CV_8UC3);
  for (int y = 0; y < labels.height(); ++y) {
    for (int x = 0; x < labels.width(); ++x) {
      pixels.at<cv::Vec3b>(y, x) = labelColour(labels.at(x, y));
    }
  }
  return pixels;
}

std::string valueSummary(const Image<float>& values, const ColourScale& scale) {
  const std::vector<float> present = presentValues(values, scale.zero_is_missing);
  if (present.empty()) return "no values";
  const auto [low, high] = std::minmax_element(present.begin(), present.end());
  const double missing =
      100.0 * (1.0 - static_cast<double>(present.size()) / static_cast<double>(values.size()));
  const int decimals = decimalsFor((*high - *low) / 100.0);
  return number(*low, decimals) + " .. " + number(*high, decimals) +
         (scale.unit.empty() ? "" : " " + scale.unit) + ", " + number(missing, 1) +
         " % without value";
}

}  // namespace rangepose::debug
