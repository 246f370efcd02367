// Points of an object before a camera, in the floats that the formulas of refinement use: one point
// or eight at a time (lanes.h). Shared by host and CUDA.
//
// Depth images are read as `read(where, u, v)`: the depth [mm] of pixels inside of the image, 0
// where nothing was measured and where `where` does not hold.
#pragma once

#include "core/camera.h"
#include "core/pose.h"
#include "stages/lanes.h"
#include "stages/surface_points.h"

namespace rangepose {

/// A camera.
struct Lens {
  bool orthographic;
  float fx, fy;  ///< [px] per 1 mm aside at a depth of 1 mm, or at any depth where orthographic
  float cx, cy;  ///< principal point [px]
  float mm_per_px_x, mm_per_px_y;  ///< 1 / fx, 1 / fy
  int width;                       ///< [px]
  int height;                      ///< [px]
};

RP_HD Lens lensOf(const Camera& camera) {
  const double fx = camera.orthographic ? 1.0 / camera.pixel_size_mm : camera.fx;
  const double fy = camera.orthographic ? 1.0 / camera.pixel_size_mm : camera.fy;
  Lens lens{};
  lens.orthographic = camera.orthographic;
  lens.fx = static_cast<float>(fx);
  lens.fy = static_cast<float>(fy);
  lens.cx = static_cast<float>(camera.cx);
  lens.cy = static_cast<float>(camera.cy);
  lens.mm_per_px_x = static_cast<float>(1.0 / fx);
  lens.mm_per_px_y = static_cast<float>(1.0 / fy);
  lens.width = camera.width;
  lens.height = camera.height;
  return lens;
}

/// Camera from object.
struct Placement {
  float turn[3][3];  ///< rows of the rotation
  float shift_mm[3];
};

RP_HD Placement placementOf(const Pose& camera_from_object) {
  Placement placement{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      placement.turn[i][j] = static_cast<float>(camera_from_object.rotation[j][i]);
    placement.shift_mm[i] = static_cast<float>(camera_from_object.translation_mm[i]);
  }
  return placement;
}

/// Points of the object, in its frame.
template <typename V>
struct PointsOf {
  typename LanesOf<V>::Mask wanted;
  Lane3<V> position_mm;
  Lane3<V> normal;  ///< see SurfacePoint
};

RP_HD PointsOf<float> onePoint(const SurfacePoint& point, bool wanted) {
  return {wanted,
          {point.position_mm.x, point.position_mm.y, point.position_mm.z},
          {point.normal.x, point.normal.y, point.normal.z}};
}

template <typename V>
RP_LANES Lane3<V> turned(const Placement& placement, const Lane3<V>& a) {
  const auto& m = placement.turn;
  return {m[0][0] * a.x + m[0][1] * a.y + m[0][2] * a.z,
          m[1][0] * a.x + m[1][1] * a.y + m[1][2] * a.z,
          m[2][0] * a.x + m[2][1] * a.y + m[2][2] * a.z};
}

template <typename V>
RP_LANES Lane3<V> placed(const Placement& placement, const Lane3<V>& a) {
  const Lane3<V> b = turned(placement, a);
  return {b.x + placement.shift_mm[0], b.y + placement.shift_mm[1], b.z + placement.shift_mm[2]};
}

template <typename V>
RP_LANES typename LanesOf<V>::Mask inFront(const Lens& lens, const Lane3<V>& point_mm) {
  using Mask = typename LanesOf<V>::Mask;
  return lens.orthographic ? Mask{} == Mask{} : point_mm.z > 1.0f;
}

template <typename V>
RP_LANES typename LanesOf<V>::Mask inImage(const Lens& lens,
                                           const typename LanesOf<V>::Int& u,
                                           const typename LanesOf<V>::Int& v) {
  return both(both(u >= 0, u < lens.width), both(v >= 0, v < lens.height));
}

/// What fx's millimetre is multiplied with to be one at this depth.
template <typename V>
RP_LANES V spread(const Lens& lens, const V& depth_mm) {
  return lens.orthographic ? all<V>(1.0f) : depth_mm;
}

template <typename V>
struct ImagePoint {
  V u;
  V v;
};

/// Of a point in front of the camera.
template <typename V>
RP_LANES ImagePoint<V> projected(const Lens& lens, const Lane3<V>& point_mm) {
  const V nearness = 1.0f / spread(lens, point_mm.z);
  return {point_mm.x * nearness * lens.fx + lens.cx, point_mm.y * nearness * lens.fy + lens.cy};
}

/// The point seen at pixel (u, v).
template <typename V>
RP_LANES Lane3<V> unprojected(const Lens& lens,
                              const typename LanesOf<V>::Int& u,
                              const typename LanesOf<V>::Int& v,
                              const V& depth_mm) {
  const V k = spread(lens, depth_mm);
  return {(asFloat(u) - lens.cx) * lens.mm_per_px_x * k,
          (asFloat(v) - lens.cy) * lens.mm_per_px_y * k,
          depth_mm};
}

/// The pixel that shows a point, where it is `wanted`, in front of the camera and in the image.
template <typename V>
struct PixelOf {
  typename LanesOf<V>::Mask in_front;
  typename LanesOf<V>::Mask inside;
  typename LanesOf<V>::Int u, v;
};

template <typename V>
RP_LANES PixelOf<V> pixelOf(const Lens& lens,
                            const typename LanesOf<V>::Mask& wanted,
                            const Lane3<V>& point_mm) {
  PixelOf<V> result;
  result.in_front = both(wanted, inFront(lens, point_mm));
  const Lane3<V> safe{point_mm.x, point_mm.y, pick(result.in_front, point_mm.z, all<V>(1.0f))};
  const ImagePoint<V> pixel = projected(lens, safe);
  const V u = pixel.u + 0.5f;
  const V v = pixel.v + 0.5f;
  // Not "outside", so that a NaN counts as outside too.
  result.inside = result.in_front && u >= 0.0f && v >= 0.0f && u < asFloat(lens.width) &&
                  v < asFloat(lens.height);
  result.u = truncated(pick(result.inside, u, V{}));
  result.v = truncated(pick(result.inside, v, V{}));
  return result;
}

}  // namespace rangepose
