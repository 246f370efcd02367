// From what is there to what a sensor of any kind measures of it.
#pragma once

#include <cstdint>
#include <functional>

#include "sim/clean_view.h"
#include "sim/sensor_model.h"

namespace rangepose {

/// What a perfect camera sees of the scene from another place, given in the frame of the depth
/// camera, which has the same orientation.
using RenderFrom = std::function<CleanView(const Camera& camera, const glm::dvec3& position_mm)>;

/// Depth as measured [mm], in whole steps of seen.camera.depth_scale (but for the sensor "none",
/// which loses nothing and takes no steps); 0 where it is lost. `seen` is the depth camera's view.
/// Same seed, same image, on any number of threads. Throws Error where the sensor needs a pinhole
/// camera and has none.
Image<float> sense(const CleanView& seen,
                   const RenderFrom& render,
                   const SensorModel& sensor,
                   std::uint64_t seed);

}  // namespace rangepose
