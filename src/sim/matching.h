// Disparity of two infrared images, by OpenCV's semi-global matcher.
#pragma once

#include <cstdint>

#include "core/image.h"
#include "sim/sensor_model.h"

namespace rangepose {

/// How far to the left of its place in `left` each pixel is found in `right` [px], in whole steps
/// of the sensor; 0 where it is not found. Matched semi-globally (Hirschmueller, PAMI 30:328,
/// 2008), checked from left to right, small patches dropped. For speckle both images are evened out
/// first. `right` may reach farther to the left than `left`, by at most the largest disparity.
/// Throws Unavailable where the program is built without OpenCV.
Image<float> matchedDisparity(const Image<std::uint8_t>& left,
                              const Image<std::uint8_t>& right,
                              const MatchingSensor& sensor,
                              SensorKind kind);

}  // namespace rangepose
