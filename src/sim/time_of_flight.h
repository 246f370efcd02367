// Depth from the phase of modulated light, by pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/clean_view.h"
#include "sim/infrared.h"
#include "sim/sensor_model.h"

namespace rangepose {

/// Depth as measured [mm], in whole steps of the camera's depth_scale; 0 where too little light
/// comes back. Light and eye are in one place.
///
/// A pixel's signal is a sum of waves: of the surfaces that the lens mixes into it, so that depth
/// between the two sides of a jump flies, and of light that comes by way of another surface, so
/// that corners seem deeper. Of the latter only surfaces within the image are known, one bounce is
/// followed, from 3 to 60 px away, and what lies between two surfaces does not hide them. The phase
/// is unwrapped by the true way: there is no error by a whole period. On top of it come noise,
/// which grows as the signal falls, a bias of dark surfaces, and a periodic error of depth.
Image<float> timeOfFlightDepth(const CleanView& view,
                               const std::vector<Reflectance>& reflectances,
                               const TimeOfFlightSensor& sensor,
                               std::uint64_t seed);

}  // namespace rangepose
