// The depth camera: pinhole (no distortion) or orthographic, and the image it took.
#pragma once

#include "core/glm.h"
#include "core/host_device.h"
#include "core/image.h"
#include "core/pose.h"

namespace rangepose {

/// Camera frame as in OpenCV: x right, y down, z forward; pixel centres at whole coordinates.
struct Camera {
  int width = 0;               ///< [px]
  int height = 0;              ///< [px]
  double fx = 0.0;             ///< focal length [px]; unused when orthographic
  double fy = 0.0;             ///< focal length [px]; unused when orthographic
  double cx = 0.0;             ///< principal point [px]
  double cy = 0.0;             ///< principal point [px]
  double depth_scale = 1.0;    ///< depth [mm] = stored value * depth_scale
  bool orthographic = false;   ///< parallel rays along z
  double pixel_size_mm = 0.0;  ///< width of a pixel of an orthographic scan [mm]

  double error_mm = 0.0;  ///< standard deviation of a depth, where known: tolerances go by it;
                          ///< 0: it is measured in each image [mm]

  /// The point seen at pixel (u, v) at depth z_mm (distance along z, not along the ray).
  RP_HD glm::dvec3 unproject(double u, double v, double z_mm) const {
    if (orthographic) return {(u - cx) * pixel_size_mm, (v - cy) * pixel_size_mm, z_mm};
    return {(u - cx) / fx * z_mm, (v - cy) / fy * z_mm, z_mm};
  }
  /// Pixel coordinates of a point in front of the camera (z > 0 unless orthographic).
  RP_HD glm::dvec2 project(const glm::dvec3& point) const {
    if (orthographic) return {point.x / pixel_size_mm + cx, point.y / pixel_size_mm + cy};
    return {point.x / point.z * fx + cx, point.y / point.z * fy + cy};
  }
  /// Unit vector along the viewing ray through a point, away from the camera.
  RP_HD glm::dvec3 viewingRay(const glm::dvec3& point) const {
    return orthographic ? glm::dvec3(0.0, 0.0, 1.0) : glm::normalize(point);
  }
  /// Spacing of neighbouring pixels on a plane at depth z_mm that faces the camera [mm].
  RP_HD double pixelSpacingMm(double z_mm) const {
    return orthographic ? pixel_size_mm : z_mm / fx;
  }

  /// Throws Error naming the bad field (singular camera matrix, zero size, non-finite value).
  void check() const;
};

/// One depth image. 0 means no measurement; every other value is finite and positive [mm].
struct DepthImage {
  Camera camera;
  Image<float> depth_mm;  ///< camera.width x camera.height
};

/// Region of interest: the inside of a bin. Bin frame: origin at the centre of the inner floor, x
/// and y along the sides, z up out of the bin.
struct BinBox {
  Pose camera_from_bin;
  glm::dvec3 inner_size_mm{0.0};  ///< x, y, height [mm]
};

/// A virtual orthographic camera: rays parallel to z of its frame, square pixels.
/// The centre of pixel (u, v) lies at x = (u + 0.5 - width / 2) * pixel_mm, y likewise.
/// Range values of such an image are z / pixel_mm, in pixels, so that x, y and z share one unit.
struct OrthoCamera {
  Pose camera_from_ortho;  ///< its frame in the depth camera's frame
  int width = 0;           ///< [px]
  int height = 0;          ///< [px]
  double pixel_mm = 1.0;   ///< [mm]

  /// Position in pixels (u, v, range) of a point given in the ortho frame in mm.
  RP_HD glm::dvec3 pixelFromOrtho(const glm::dvec3& point_mm) const {
    return {point_mm.x / pixel_mm + 0.5 * width - 0.5,
            point_mm.y / pixel_mm + 0.5 * height - 0.5,
            point_mm.z / pixel_mm};
  }
  RP_HD glm::dvec3 orthoFromPixel(double u, double v, double range_px) const {
    return {(u + 0.5 - 0.5 * width) * pixel_mm,
            (v + 0.5 - 0.5 * height) * pixel_mm,
            range_px * pixel_mm};
  }
};

}  // namespace rangepose
