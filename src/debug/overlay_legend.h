// The colours of an overlay and the legend that explains them.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "debug/overlay.h"

namespace rangepose::debug {

// Blue, green, red.
inline const cv::Scalar kMissingTint{150, 90, 170};  ///< model over pixels without measurement
inline const cv::Scalar kOutlineColour{40, 225, 255};
inline const std::array<cv::Scalar, 3> kAxisColours{
    cv::Scalar{40, 40, 255}, cv::Scalar{60, 230, 60}, cv::Scalar{255, 110, 50}};

cv::Mat overlayLegend(double tolerance_mm);

}  // namespace rangepose::debug
