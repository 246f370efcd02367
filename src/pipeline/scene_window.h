// The virtual orthographic cameras through which a scene is looked at.
#pragma once

#include "core/camera.h"
#include "stages/foreground.h"
#include "stages/reference.h"
#include "stages/search.h"

namespace rangepose {

/// Looks along the sensor's axis at all points of that extent, at `pixel_mm` a pixel or, where that
/// would make more than `max_px` pixels along a side, coarser. Width 0 when there is none.
OrthoCamera sceneCamera(const LateralExtent& extent, double pixel_mm, int max_px);

/// Looks along the sensor's viewing ray through `point_mm` (camera frame), which lies in the middle
/// of the image: there an orthographic reference is a good model of what a perspective sensor sees.
OrthoCamera windowCamera(const Camera& sensor,
                         const glm::dvec3& point_mm,
                         int width_px,
                         double pixel_mm);

/// Sensor pixels that can fall into such a window, of a cube as deep as it is wide: what is farther
/// off is no part of the object.
PixelBox windowRegion(const Camera& sensor,
                      const glm::dvec3& point_mm,
                      int width_px,
                      double pixel_mm);

/// The pose that a hypothesis stands for, in the frame of the sensor.
Pose poseOf(const Hypothesis& hypothesis, const ReferenceObject& object, const OrthoCamera& window);

}  // namespace rangepose
