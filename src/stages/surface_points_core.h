// A point of a rendered surface, and how many of them are taken. Shared by host and CUDA.
#pragma once

#include <cmath>

#include "core/device.h"
#include "stages/surface_points.h"

namespace rangepose {

/// Rows and columns to step on so that about `max_points` of `count` remain.
RP_HD int pointStride(float count, int max_points) {
  const int stride = static_cast<int>(std::ceil(std::sqrt(count / static_cast<float>(max_points))));
  return stride < 1 ? 1 : stride;
}

/// What pixel (x, y) of a rendered surface shows, in the object's frame.
RP_HD SurfacePoint pointOfTexel(const SurfaceTexel& texel,
                                const Camera& camera,
                                const SurfaceWindow& window,
                                const Pose& object_from_camera,
                                int x,
                                int y) {
  const glm::dvec3 point = camera.unproject(
      window.x0 + x * window.step, window.y0 + y * window.step, static_cast<double>(texel.w));
  return {glm::vec3(object_from_camera * point),
          glm::vec3(object_from_camera.rotation * glm::dvec3(texel))};
}

}  // namespace rangepose
