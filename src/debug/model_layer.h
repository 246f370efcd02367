// The models of an overlay, rendered for one view and painted over its relief.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "debug/overlay.h"
#include "debug/relief.h"
#include "stages/surface.h"

namespace rangepose::debug {

/// What is seen of all models together in one view.
struct ModelLayer {
  Image<SurfaceTexel> surface;  ///< of the nearest model
  Image<int> owner;             ///< index of its pose, -1 where no model is seen
};

ModelLayer renderModels(const std::vector<OverlayPose>& poses, const Camera& camera);

/// The view of `relief_pixels` with the models over it: difference colours, feature edges,
/// outlines.
cv::Mat paintModels(const DepthImage& image,
                    const cv::Mat& relief_pixels,
                    const std::vector<OverlayPose>& poses,
                    const PictureView& view,
                    double tolerance_mm);

/// The axes of each object at its origin: x red, y green, z blue.
void drawAxes(cv::Mat& picture, const OverlayPose& pose, const Camera& camera);

/// The rectangle of the depth image that the visible part of a model covers; empty when it is not
/// seen.
PixelBox projectedBox(const OverlayPose& pose, const Camera& camera);

}  // namespace rangepose::debug
