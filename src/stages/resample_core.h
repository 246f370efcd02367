// Where a measured pixel lands in an orthographic range image. Shared by host and CUDA;
// twin: glsl/resample.vert.
#pragma once

#include "stages/lanes.h"

namespace rangepose {

/// Pixels that one measurement may cover along a side.
inline constexpr int kMaxFootprint = 8;

/// The numbers of a resampling, in float as every back-end uses them.
/// ortho = rotation * (ray * depth + origin) + translation, all in pixels of the range image.
struct ResampleSetup {
  float inv_fx, inv_fy, cx, cy;  ///< ray of pixel (u, v): ((u - cx) * inv_fx, (v - cy) * inv_fy)
  float parallel;          ///< 1 for an orthographic sensor (x, y do not grow with depth), else 0
  float rotation[9];       ///< ortho_from_camera, row-major, divided by pixel_mm
  float translation[3];    ///< of the same transform, plus the image centre [px]
  float footprint_per_mm;  ///< width of a sensor pixel at 1 mm depth (or at all depths) [px]
};

/// Of one measured pixel (V = float) or eight (Float8), see lanes.h.
template <typename V>
struct SplatOf {
  using Int = typename LanesOf<V>::Int;
  typename LanesOf<V>::Mask drawn;  ///< in front of the camera, and not far outside of any image
  Int x, y;                         ///< first pixel covered
  Int count;                        ///< pixels covered along each side
  V range;                          ///< [px]
};

/// Of whole numbers.
template <typename V>
RP_LANES typename LanesOf<V>::Int floored(const V& value) {
  const auto whole = truncated(value);
  return pick(value < asFloat(whole), whole - 1, whole);
}

/// What measured pixel (u, v) covers. A depth of 0 must be skipped by the caller.
template <typename V>
RP_LANES SplatOf<V> splatOf(const ResampleSetup& s, const V& u, const V& v, const V& depth_mm) {
  using Int = typename LanesOf<V>::Int;
  const V one = V{} + 1.0f;
  const V reach = s.parallel != 0.0f ? one : depth_mm;
  const V x = (u - s.cx) * s.inv_fx * reach;
  const V y = (v - s.cy) * s.inv_fy * reach;
  const V px = s.rotation[0] * x + s.rotation[1] * y + s.rotation[2] * depth_mm + s.translation[0];
  const V py = s.rotation[3] * x + s.rotation[4] * y + s.rotation[5] * depth_mm + s.translation[1];
  const V pz = s.rotation[6] * x + s.rotation[7] * y + s.rotation[8] * depth_mm + s.translation[2];
  // No image is that wide; past it the conversions below would overflow. A NaN fails too.
  constexpr float kFarthestPx = 1.0e6f;
  const auto near = both(magnitude(px) < kFarthestPx, magnitude(py) < kFarthestPx);
  const V width = pick(near, V(s.footprint_per_mm * reach), one);
  const V most = V{} + static_cast<float>(kMaxFootprint);
  const Int count = -floored(V(-pick(width < most, pick(width < one, one, width), most)));
  // The centre of pixel k is at k: the pixels covered are those nearest to the point.
  const V shift = 0.5f * (asFloat(count) - 1.0f) - 0.5f;
  const V left = pick(near, V(px - shift), V{});
  const V top = pick(near, V(py - shift), V{});
  return {both(near, pz > 0.0f), floored(left), floored(top), count, pz};
}

}  // namespace rangepose
