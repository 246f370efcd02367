// Depth images: 16-bit PNG, 16-bit or float TIFF, float EXR.
//
// Each format is read by its own library and not through OpenCV, which prints on damaged files,
// decodes before it can be asked for the size, and knows no EXR channel named Z.
#pragma once

#include <filesystem>

#include "core/camera.h"

namespace rangepose {

/// Depth in mm is the stored value times camera.depth_scale; NaN, infinite and negative values
/// become 0 (no measurement). The camera takes the image's size, see withImageSize(). The format is
/// told by the content, not by the name. An EXR file has one channel, or one named Z or Depth
/// beside others.
///
/// Throws Error for a missing, empty, truncated, damaged or oversized (kMaxImagePixels) file, for
/// colour and for 8-bit images. An image without any measurement is no error, see validPixels().
DepthImage readDepth(const std::filesystem::path& path, const Camera& camera);

/// Number of pixels with a measurement.
int validPixels(const DepthImage& image);

/// Writes depth / camera.depth_scale, rounded, as 16-bit PNG, whole or not at all. Throws Error for
/// a value beyond 65535: choose a larger depth_scale.
void writeDepthPng(const std::filesystem::path& path, const DepthImage& image);

}  // namespace rangepose
