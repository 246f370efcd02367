// Single pixels that a sensor lost.
#pragma once

#include "core/camera.h"

namespace rangepose::host {

/// The image with single lost pixels filled: holes with at least six measured neighbours that lie
/// on one surface, by the mean of those on opposite sides. A sensor that loses pixels here and
/// there has seen what is around them; as holes they would leave every part with an outline of
/// which nothing is known. Larger holes stay, and holes at edges and on steep slopes, which have
/// their reasons. So do all where such holes are few: then they have reasons, too. `noise_mm` as of
/// depthNoise.
DepthImage fillDropouts(const DepthImage& image, double noise_mm);

}  // namespace rangepose::host
