// Where a measured pixel lands in an orthographic range image. Shared by host and CUDA;
// twin: glsl/resample.vert.
#pragma once

#include "stages/device.h"

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

struct Splat {
  int x, y;     ///< first pixel covered
  int count;    ///< pixels covered along each side; 0 when far outside of any image
  float range;  ///< [px]
};

/// A depth of 0 must be skipped by the caller.
RP_HD Splat splatOf(const ResampleSetup& s, int u, int v, float depth_mm) {
  const float reach = s.parallel != 0.0f ? 1.0f : depth_mm;
  const float x = (static_cast<float>(u) - s.cx) * s.inv_fx * reach;
  const float y = (static_cast<float>(v) - s.cy) * s.inv_fy * reach;
  const float px =
      s.rotation[0] * x + s.rotation[1] * y + s.rotation[2] * depth_mm + s.translation[0];
  const float py =
      s.rotation[3] * x + s.rotation[4] * y + s.rotation[5] * depth_mm + s.translation[1];
  const float pz =
      s.rotation[6] * x + s.rotation[7] * y + s.rotation[8] * depth_mm + s.translation[2];
  // No image is that wide; past it the conversions below would overflow. Written so that a NaN
  // fails too.
  constexpr float kFarthestPx = 1.0e6f;
  const bool near = px > -kFarthestPx && px < kFarthestPx && py > -kFarthestPx && py < kFarthestPx;
  if (!near) return {0, 0, 0, pz};
  const float width = s.footprint_per_mm * reach;
  int count =
      static_cast<int>(width) + (width > static_cast<float>(static_cast<int>(width)) ? 1 : 0);
  if (count < 1) count = 1;
  if (count > kMaxFootprint) count = kMaxFootprint;
  // The centre of pixel k is at k: the pixels covered are those nearest to the point.
  const float shift = 0.5f * static_cast<float>(count - 1) - 0.5f;
  const float left = px - shift;
  const float top = py - shift;
  const int x0 =
      static_cast<int>(left) - (left < static_cast<float>(static_cast<int>(left)) ? 1 : 0);
  const int y0 = static_cast<int>(top) - (top < static_cast<float>(static_cast<int>(top)) ? 1 : 0);
  return {x0, y0, count, pz};
}

}  // namespace rangepose
