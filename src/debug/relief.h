// A depth image as a shaded relief: what the sensor measured, readable without a colour scale.
#pragma once

#include <opencv2/core.hpp>

#include "core/camera.h"

namespace rangepose::debug {

/// Colour of pixels without measurement in a relief: the only ones that are not grey.
inline const cv::Vec3b kHoleColour{72, 38, 58};

/// Grey values from the normals of the measured surface, lit from the upper left; farther surfaces
/// are a little darker, steps in depth are darkened on their far side. One pixel a depth pixel.
cv::Mat relief(const DepthImage& image);

/// A rectangle of a depth image, enlarged or reduced to a picture.
struct PictureView {
  PixelBox source;     ///< rectangle of the depth image [px]
  double scale = 1.0;  ///< picture pixels a depth pixel
  int width = 0;       ///< of the picture [px]
  int height = 0;      ///< of the picture [px]

  /// Column and row of the depth pixel under a picture pixel.
  int sourceX(int x) const;
  int sourceY(int y) const;
  /// Where the centre of a depth pixel lies in the picture [px].
  cv::Point2d pictureFrom(double u, double v) const;
  /// The camera that sees this picture, with the depth camera's eye.
  Camera camera(const Camera& depth_camera) const;
};

PictureView pictureView(const PixelBox& source, double scale);

/// The part of `pixels` (one a depth pixel) that a view shows.
cv::Mat shown(const cv::Mat& pixels, const PictureView& view);

}  // namespace rangepose::debug
