// What one depth image tells of its sensor.
#pragma once

#include "core/camera.h"
#include "stages/sensor_facts.h"

namespace rangepose::host {

/// From the whole image as measured, background included: floors and walls show a sensor best.
/// `between_neighbours_mm` is depthNoise() of it [mm]. Errors that are correlated over many pixels
/// cannot be told from the shapes of parts by an image alone: the evidence takes them from what
/// each pose leaves (relief_core.h).
SensorFacts sensorFacts(const DepthImage& image, double between_neighbours_mm);

}  // namespace rangepose::host
