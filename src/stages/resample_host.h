// Depth image -> orthographic range image: every measured pixel is splatted, the nearest one wins.
#pragma once

#include <cstdint>

#include "core/camera.h"
#include "core/image.h"
#include "stages/resample_core.h"

namespace rangepose {

/// The numbers that every back-end resamples with.
ResampleSetup resampleSetup(const Camera& sensor, const OrthoCamera& camera);

namespace host {

/// `keep`, if not empty, has the size of the image; pixels where it is 0 are left out (background).
/// `region` limits the pixels that are read; an empty box means all of them.
/// Returns range [px], 0 where nothing was measured or it lies behind the virtual camera. A
/// measured pixel covers ceil(its own width / camera.pixel_mm) pixels along each side, at most
/// kMaxFootprint, so that a fine grid has no pin holes where the surface faces the sensor. Surfaces
/// that lean away from it, or a camera rolled about its own axis, may leave gaps one pixel wide:
/// the median closes them.
Image<float> resample(const DepthImage& image,
                      const Image<std::uint8_t>& keep,
                      const OrthoCamera& camera,
                      const PixelBox& region = {});

}  // namespace host
}  // namespace rangepose
