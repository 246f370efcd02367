#include "stages/surface_points.h"

#include <algorithm>
#include <cmath>

#include "stages/surface_points_core.h"

namespace rangepose {

std::vector<SurfacePoint> pointsOfView(const ReferenceObject& object, int view, int max_points) {
  const ReferenceView& reference = object.views[static_cast<std::size_t>(view)];
  const glm::ivec2 origin = object.tileOrigin(view);
  const glm::dmat3 object_from_view = glm::transpose(reference.rotation);
  const int stride = pointStride(reference.area_px, max_points);
  const auto usable = [&](int u, int v) {
    const ReferenceTexel& texel = object.atlas.at(origin.x + u, origin.y + v);
    return texel.a > 0.0f && texel.b == 0.0f;
  };
  const auto range = [&](int u, int v) { return object.atlas.at(origin.x + u, origin.y + v).g; };
  std::vector<SurfacePoint> points;
  // A pixel that is no edge has eight neighbours on the same smooth surface.
  for (int v = std::max(reference.box.y0, 1); v < std::min(reference.box.y1, object.size - 1);
       v += stride) {
    for (int u = std::max(reference.box.x0, 1); u < std::min(reference.box.x1, object.size - 1);
         u += stride) {
      if (!usable(u, v)) continue;
      const double half = 0.5 * object.size;
      const glm::dvec3 in_view(
          u + 0.5 - half, v + 0.5 - half, static_cast<double>(range(u, v)) - object.size);
      const glm::dvec3 normal = glm::normalize(glm::dvec3(0.5 * (range(u + 1, v) - range(u - 1, v)),
                                                          0.5 * (range(u, v + 1) - range(u, v - 1)),
                                                          -1.0));
      points.push_back(
          {glm::vec3(object_from_view * (in_view * object.pixel_mm) + object.center_mm),
           glm::vec3(object_from_view * normal)});
    }
  }
  return points;
}

namespace {

int strideOn(const Image<SurfaceTexel>& surface, int max_points) {
  const auto seen = std::count_if(
      surface.begin(), surface.end(), [](const SurfaceTexel& texel) { return texel.w > 0.0f; });
  return pointStride(static_cast<float>(seen), max_points);
}

}  // namespace

std::vector<SurfacePoint> pointsOfSurface(const Image<SurfaceTexel>& surface,
                                          const Camera& camera,
                                          const SurfaceWindow& window,
                                          const Pose& camera_from_object,
                                          int max_points) {
  const int stride = strideOn(surface, max_points);
  const Pose object_from_camera = camera_from_object.inverse();
  std::vector<SurfacePoint> points;
  for (int y = stride / 2; y < surface.height(); y += stride) {
    for (int x = stride / 2; x < surface.width(); x += stride) {
      const SurfaceTexel& texel = surface.at(x, y);
      if (texel.w <= 0.0f) continue;
      points.push_back(pointOfTexel(texel, camera, window, object_from_camera, x, y));
    }
  }
  return points;
}

std::vector<SurfacePoint> rimOfSurface(const Image<SurfaceTexel>& surface,
                                       const Camera& camera,
                                       const SurfaceWindow& window,
                                       const Pose& camera_from_object,
                                       int max_points) {
  const int stride = rimStride(strideOn(surface, max_points));
  const auto read = [&](int x, int y) { return surface.at(x, y); };
  const Pose object_from_camera = camera_from_object.inverse();
  std::vector<SurfacePoint> points;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfaceTexel& texel = surface.at(x, y);
      if (texel.w <= 0.0f || !isRim(read, window, x, y, stride)) continue;
      const glm::dvec2 out = outOfSurface(read, window, x, y);
      if (out == glm::dvec2(0.0)) continue;
      points.push_back(rimOfTexel(texel, out, camera, window, object_from_camera, x, y));
    }
  }
  return points;
}

}  // namespace rangepose
