// False-colour pictures of scalar fields, with a bar that says what the colours mean.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "core/image.h"

namespace rangepose::debug {

/// How values become colours. Values outside of [min, max] take the colour of the nearer end.
struct ColourScale {
  std::string name;             ///< of the quantity, e.g. "depth"
  std::string unit;             ///< e.g. "mm"; empty for pure numbers
  float min = 0.0f;             ///< [unit]
  float max = 1.0f;             ///< [unit]
  bool zero_is_missing = true;  ///< 0 means "not measured"; non-finite values always do
  bool signed_field = false;    ///< blue - white - red about the middle instead of viridis
};

/// Colour of pixels without a value (blue, green, red); no colour scale contains it.
inline const cv::Vec3b kMissingColour{64, 64, 64};

inline constexpr int kBarStripPx = 20;   ///< width of the coloured strip of a bar [px]
inline constexpr int kBarMarginPx = 10;  ///< rows above and below the strip [px]

/// The scale over the values that are there; the outermost 0.5 % at either end are clipped, so that
/// flying pixels do not eat the contrast.
ColourScale scaleOf(const Image<float>& values,
                    const std::string& name,
                    const std::string& unit,
                    bool zero_is_missing = true);

/// A scale about 0, as wide as the largest magnitude, for fields with a sign.
ColourScale signedScaleOf(const Image<float>& values,
                          const std::string& name,
                          const std::string& unit,
                          bool zero_is_missing = false);

bool isMissing(float value, const ColourScale& scale);

cv::Vec3b colourOf(float value, const ColourScale& scale);

/// One pixel a value.
cv::Mat colourPixels(const Image<float>& values, const ColourScale& scale);

/// A vertical bar, largest value on top: the strip in columns 0 .. kBarStripPx - 1 from row
/// kBarMarginPx to height - kBarMarginPx - 1, numbers and "name [unit]" to its right.
cv::Mat colourBar(const ColourScale& scale, int height);

/// colourPixels, enlarged by enlargement(width, height, target_px) with its upper left corner at
/// (0, 0), and kGapPx to the right of it the bar.
cv::Mat colourMap(const Image<float>& values, const ColourScale& scale, int target_px = 960);

/// A colour for a label: the same label has the same colour in every picture, neighbouring labels
/// differ. Negative labels (no patch) are kMissingColour.
cv::Vec3b labelColour(std::int32_t label);

/// One pixel a label.
cv::Mat labelPixels(const Image<std::int32_t>& labels);

/// What the values are like: "lowest .. highest unit, n % without value".
std::string valueSummary(const Image<float>& values, const ColourScale& scale);

}  // namespace rangepose::debug
