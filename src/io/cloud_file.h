// Point clouds (PLY, PCD 0.7) and the depth image that one of them stands for.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "io/length_unit.h"

namespace rangepose {

/// Points in the camera frame. An organised cloud has height > 1 and keeps the sensor's pixels row
/// by row, points without a measurement included (NaN or 0).
struct PointCloud {
  std::vector<glm::vec3> points_mm;  ///< [mm], width * height of them
  int width = 0;                     ///< [px], or the number of points when not organised
  int height = 1;                    ///< [px], 1 when not organised
};

/// PLY: ASCII or binary, x y z of the element vertex; organised when num_cols and num_rows are
/// given. PCD: ascii, binary or binary_compressed, fields x y z of type F in any order. The
/// VIEWPOINT is not applied: points are taken to be in the frame of the camera. The format is told
/// by the content.
///
/// Clouds carry no unit; those of PCL and of ROS are in metres. Throws Error for a missing, empty,
/// truncated or damaged file, and for one without points.
PointCloud readCloud(const std::filesystem::path& path, LengthUnit unit);

/// The depth image of a cloud. Points with z <= 0 or a value that is not finite are dropped.
///
/// With a camera, points are projected, the nearest wins; a camera without a size takes that of an
/// organised cloud. Without one, the pinhole camera of an organised cloud is fitted to its grid;
/// where that does not fit (by half a pixel) or there is no grid, a camera at the origin is made
/// up: it looks along +z, holds all points within 80 degrees of that axis, and its pixels are as
/// wide as the distance of neighbouring points, or wider where the image would exceed 2048 pixels.
DepthImage depthFromCloud(const PointCloud& cloud, const std::optional<Camera>& camera);

}  // namespace rangepose
