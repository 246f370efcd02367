#include "stages/surface_points.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "stages/surface_points_core.h"

namespace rangepose {

namespace {

/// A point of a view, given in pixels of its tile and in range, in the object's frame.
glm::vec3 inObject(const ReferenceObject& object,
                   const glm::dmat3& object_from_view,
                   double u,
                   double v,
                   double range_px) {
  const double half = 0.5 * object.size;
  const glm::dvec3 in_view(u + 0.5 - half, v + 0.5 - half, range_px - object.size);
  return glm::vec3(object_from_view * (in_view * object.pixel_mm) + object.center_mm);
}

/// How fast the range of a view grows towards its rim at pixel (u, v), from what lies inside of it;
/// 0 where it bends away from the viewer: that says nothing about where it ends. `across` is the
/// way out, a unit vector.
template <typename Range>
double slopeAtRim(const Range& range, int u, int v, const glm::dvec2& across) {
  constexpr double kNear = 1.5;  // from the rim, which may be rounded [px]
  constexpr double kFar = 3.5;
  const glm::ivec2 near = glm::ivec2(glm::floor(glm::dvec2(u, v) - kNear * across + 0.5));
  const glm::ivec2 far = glm::ivec2(glm::floor(glm::dvec2(u, v) - kFar * across + 0.5));
  const double near_px = range(near.x, near.y);
  const double far_px = range(far.x, far.y);
  if (near_px == 0.0 || far_px == 0.0) return 0.0;
  const double slope = (near_px - far_px) / glm::dot(glm::dvec2(near - far), across);
  return std::abs(slope) < kSteepestRim ? slope : 0.0;
}

/// Names that no other points have.
ViewPoints nobodysPoints(std::size_t views) {
  static std::atomic<std::uint64_t> next{1};
  ViewPoints points;
  points.of.resize(views);
  points.first_name = next.fetch_add(views);
  return points;
}

}  // namespace

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
      const glm::dvec3 normal = glm::normalize(glm::dvec3(0.5 * (range(u + 1, v) - range(u - 1, v)),
                                                          0.5 * (range(u, v + 1) - range(u, v - 1)),
                                                          -1.0));
      points.push_back({inObject(object, object_from_view, u, v, static_cast<double>(range(u, v))),
                        glm::vec3(object_from_view * normal)});
    }
  }
  return points;
}

std::vector<SurfacePoint> rimOfView(const ReferenceObject& object, int view, int max_points) {
  const ReferenceView& reference = object.views[static_cast<std::size_t>(view)];
  const glm::ivec2 origin = object.tileOrigin(view);
  const glm::dmat3 object_from_view = glm::transpose(reference.rotation);
  const int stride = rimStride(pointStride(reference.area_px, max_points));
  const int half = stride / 2;  // as in isRim
  const SurfaceWindow tile{0, 0, object.size, object.size, 1};
  const auto range = [&](int u, int v) {
    if (u < 0 || v < 0 || u >= object.size || v >= object.size) return 0.0f;
    const ReferenceTexel& texel = object.atlas.at(origin.x + u, origin.y + v);
    return texel.a > 0.0f ? texel.g : 0.0f;
  };
  const auto surface = [&](int u, int v) { return SurfaceTexel(0.0f, 0.0f, 0.0f, range(u, v)); };
  std::vector<SurfacePoint> points;
  for (int v = reference.box.y0; v < reference.box.y1; ++v) {
    // Only every stride-th row is looked at whole.
    const bool whole = v % stride == half;
    const int first = reference.box.x0;
    const int begin = whole ? first : first + (half - first % stride + stride) % stride;
    for (int u = begin; u < reference.box.x1; u += whole ? 1 : stride) {
      if (range(u, v) == 0.0f || !isRim(surface, tile, u, v, stride)) continue;
      const glm::dvec2 out = outOfSurface(surface, tile, u, v);
      if (out == glm::dvec2(0.0)) continue;
      const glm::dvec2 across = glm::normalize(out);
      const glm::dvec3 tangent(across, slopeAtRim(range, u, v, across));
      const glm::dvec3 end =
          glm::dvec3(u, v, static_cast<double>(range(u, v))) + outOfRimPixels(across) * tangent;
      points.push_back({inObject(object, object_from_view, end.x, end.y, end.z),
                        glm::vec3(object_from_view * glm::normalize(tangent)),
                        true});
    }
  }
  return points;
}

std::vector<SurfacePoint> pointsAndRimOfView(const ReferenceObject& object,
                                             int view,
                                             int max_points) {
  std::vector<SurfacePoint> points = pointsOfView(object, view, max_points);
  const std::vector<SurfacePoint> rim = rimOfView(object, view, max_points);
  points.insert(points.end(), rim.begin(), rim.end());
  return points;
}

namespace {

int strideOn(const Image<SurfaceTexel>& surface, int max_points) {
  const auto seen = std::count_if(
      surface.begin(), surface.end(), [](const SurfaceTexel& texel) { return texel.w > 0.0f; });
  return pointStride(static_cast<float>(seen), max_points);
}

}  // namespace

std::shared_ptr<const ViewPoints> PointsOfViews::of(const ReferenceObject& object,
                                                    int max_points,
                                                    std::vector<int> views) {
  constexpr int kViewsPerPiece = 16;
  const std::shared_ptr<ViewPoints> points =
      kept_.of({object.serial, max_points}, [&] { return nobodysPoints(object.views.size()); });
  const auto of = [&](int view) -> std::vector<SurfacePoint>& {
    return points->of[static_cast<std::size_t>(view)];
  };
  std::erase_if(views, [&](int view) { return !of(view).empty(); });
  std::sort(views.begin(), views.end());
  views.erase(std::unique(views.begin(), views.end()), views.end());
  parallelFor(static_cast<int>(views.size()), kViewsPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int view = views[static_cast<std::size_t>(i)];
      of(view) = pointsAndRimOfView(object, view, max_points);
    }
  });
  return points;
}

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
