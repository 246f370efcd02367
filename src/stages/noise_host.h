// How noisy a depth image is.
#pragma once

#include <cstdint>

#include "core/camera.h"

namespace rangepose::host {

/// Standard deviation of the depth noise [mm] over the measured pixels of the mask: from second
/// differences along rows, which do not see a plane of any slope; only the lower half of them,
/// which leaves edges out. 0 for fewer than 100 triples.
double depthNoise(const DepthImage& image, const Image<std::uint8_t>& mask);

}  // namespace rangepose::host
