// The pixels of a depth image that a posed part accounts for.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "stages/surface.h"

namespace rangepose {

/// Surfaces of a part and of the data closer than this [mm] are the same, where `tolerance_mm` is
/// that of the part's check: twice, for what a pose is off leaves no rim of a found part to others.
double sameSurfaceMm(double tolerance_mm);

/// Indices into the depth image (row by row) of the measured pixels within `same_mm` of the
/// rendered surface. The window is one of the image, with step 1.
std::vector<std::int32_t> explainedPixels(const Image<SurfaceTexel>& surface,
                                          const SurfaceWindow& window,
                                          const DepthImage& depth,
                                          double same_mm);

}  // namespace rangepose
