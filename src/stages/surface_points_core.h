// A point of a rendered surface, and how many of them are taken. Shared by host and CUDA.
#pragma once

#include <cmath>

#include "core/host_device.h"
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

/// Points of the rim lie on rows and columns so many texels apart.
RP_HD int rimStride(int point_stride) { return 2 * point_stride; }

/// Whether a rendered surface, `surface(x, y)`, shows nothing at a pixel of its window.
template <typename Surface>
RP_HD bool showsNothing(const Surface& surface, const SurfaceWindow& window, int x, int y) {
  if (x < 0 || y < 0 || x >= window.width || y >= window.height) return false;
  return surface(x, y).w <= 0.0f;
}

/// Whether pixel (x, y), which shows the object, is a rim on every `stride`-th row or column.
template <typename Surface>
RP_HD bool isRim(const Surface& surface, const SurfaceWindow& window, int x, int y, int stride) {
  const auto ends = [&](int dx, int dy) { return showsNothing(surface, window, x + dx, y + dy); };
  return (y % stride == stride / 2 && (ends(1, 0) || ends(-1, 0))) ||
         (x % stride == stride / 2 && (ends(0, 1) || ends(0, -1)));
}

/// Where a rendered surface ends around pixel (x, y), as a direction [px]; zero if on all sides.
template <typename Surface>
RP_HD glm::dvec2 outOfSurface(const Surface& surface, const SurfaceWindow& window, int x, int y) {
  constexpr int kReach = 2;
  glm::dvec2 out(0.0);
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (showsNothing(surface, window, x + dx, y + dy)) out += glm::dvec2(dx, dy);
    }
  }
  return out;
}

/// How far a straight rim lies out of the pixels that isRim takes, on average [px]: along rows they
/// lie inside by 0 to |across.x| and there are |across.y| as many; columns alike. `across` is the
/// way out, a unit vector.
RP_HD double outOfRimPixels(const glm::dvec2& across) {
  return 0.5 / (std::fabs(across.x) + std::fabs(across.y));
}

/// Where a surface bends away from the viewer by more than this its slope says nothing about where
/// it ends.
inline constexpr double kSteepestRim = 2.0;

/// The rim that pixel (x, y) shows: so far out of its centre as the pixels that isRim takes lie
/// inside of a straight rim on average. `out` as from outOfSurface, not zero.
RP_HD SurfacePoint rimOfTexel(const SurfaceTexel& texel,
                              const glm::dvec2& out,
                              const Camera& camera,
                              const SurfaceWindow& window,
                              const Pose& object_from_camera,
                              int x,
                              int y) {
  const glm::dvec2 across = out / std::sqrt(glm::dot(out, out));
  const glm::dvec3 normal(texel);
  const double rise = -(across.x * normal.x + across.y * normal.y);
  const double slope = std::fabs(rise) < kSteepestRim * std::fabs(normal.z) ? rise / normal.z : 0.0;
  const glm::dvec3 tangent(across, slope);
  const double z = static_cast<double>(texel.w);
  const double inside_mm = outOfRimPixels(across) * window.step * camera.pixelSpacingMm(z);
  const glm::dvec3 point =
      camera.unproject(window.x0 + x * window.step, window.y0 + y * window.step, z) +
      inside_mm * tangent;
  return {glm::vec3(object_from_camera * point),
          glm::vec3(object_from_camera.rotation * (tangent / std::sqrt(1.0 + slope * slope))),
          true};
}

}  // namespace rangepose
