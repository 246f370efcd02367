#include "core/camera.h"

#include <cmath>

namespace rangepose {

void Camera::check() const {
  RP_CHECK(width > 0 && height > 0, "camera: width and height must be positive");
  RP_CHECK(std::isfinite(cx) && std::isfinite(cy),
           "camera: cam_K has a non-finite principal point");
  RP_CHECK(std::isfinite(depth_scale) && depth_scale > 0.0, "camera: depth_scale must be positive");
  RP_CHECK(std::isfinite(error_mm) && error_mm >= 0.0,
           "camera: error_mm must be positive, or 0 where it is not known");
  if (orthographic) {
    RP_CHECK(std::isfinite(pixel_size_mm) && pixel_size_mm > 0.0,
             "camera: pixel_size must be positive");
    return;
  }
  RP_CHECK(std::isfinite(fx) && std::isfinite(fy) && fx > 0.0 && fy > 0.0,
           "camera: cam_K is singular (focal lengths must be positive)");
}

}  // namespace rangepose
