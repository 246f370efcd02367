// One picture for each kind of intermediate result. StageDump names, writes and lists them.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose::debug {

/// Relief and depth in colours, side by side.
cv::Mat depthPicture(const DepthImage& image);

/// The relief with the pixels that are taken for background in ochre. `keep` as in host::resample.
cv::Mat keepMaskPicture(const DepthImage& image, const Image<std::uint8_t>& keep);

cv::Mat rangePicture(const Image<float>& range_px);

/// Edges yellow, other measured pixels light grey, the rest dark grey; one pixel a pixel.
cv::Mat edgePixels(const Image<float>& range_px, const Image<float>& edges);

cv::Mat edgePicture(const Image<float>& range_px, const Image<float>& edges);

cv::Mat distancePicture(const Image<float>& distance_px);

cv::Mat patchPicture(const Image<std::int32_t>& labels);

/// Numbered starts on the range image; the circle is as large as the distance to the nearest edge.
cv::Mat seedPicture(const Image<float>& range_px, const std::vector<Seed>& seeds);

/// A row a window: range, edges, signed distance; the square is the size of a reference image.
cv::Mat windowPicture(const std::vector<SceneChannels>& windows);

/// A row a window: its range with the outline of its best view, the range which that view predicts,
/// and the difference of both.
cv::Mat bestViewPicture(const ReferenceObject& object,
                        const std::vector<SceneChannels>& windows,
                        const std::vector<Hypothesis>& hypotheses);

/// Range, edges, signed distance and |cos(view, normal)| of `count` views from `first`.
cv::Mat atlasPicture(const ReferenceObject& object, int first, int count);

}  // namespace rangepose::debug
