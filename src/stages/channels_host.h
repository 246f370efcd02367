// The image stages on the host: 3x3 median, edges, signed distance transform (paper
// Sect. 5.1, 5.2).
#pragma once

#include "core/image.h"
#include "stages/scene_channels.h"

namespace rangepose::host {

/// 3x3 median; pixels outside repeat the border (as OpenCV's medianBlur does).
Image<float> median(const Image<float>& range);

/// 1 where a pixel has a range and this jumps by more than `threshold_px` (background counts as
/// range 0), and where it is that steep beside a jump: see stepOfNine() and edgeOfSteps(). Outside
/// of the image its border repeats.
Image<float> edges(const Image<float>& range_px, float threshold_px);

/// The texels after `passes` passes of Algorithm 1.
Image<EdtTexel> distanceTexels(const Image<float>& range_px, const Image<float>& edges, int passes);

/// Signed distance [px]: the root of distanceTexels, clamped to +-(passes + 1).
Image<float> distance(const Image<float>& range_px, const Image<float>& edges, int passes);

/// Label of each pixel: the smallest index (y * width + x) among the 4-connected non-edge pixels
/// with a range that it is connected to; kNoPatch on edges and background (paper Sect. 5.3).
Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges);

/// Median, edges and distance in one call.
SceneChannels channels(const OrthoCamera& camera,
                       const Image<float>& range_px,
                       const ChannelOptions& options);

}  // namespace rangepose::host
