// One lost pixel and what is measured around it. Shared by host and CUDA.
#pragma once

#include "core/camera.h"

namespace rangepose {

/// Whether so many lost pixels are filled: simulated sensors lose 0.2 or 8 % of the measured ones.
RP_HD bool areMany(int lost, int measured) {
  constexpr double kMany = 0.02;
  return static_cast<double>(lost) > kMany * static_cast<double>(measured);
}

/// Depth [mm] of pixel (u, v), which was not measured and is none of the image's border, by its
/// neighbours; 0 where it stays a hole. `read(u, v)` gives a depth [mm]. See host::fillDropouts.
template <typename Read>
RP_HD float filledDropout(const Camera& camera, const Read& read, int u, int v, double noise_mm) {
  constexpr int kMeasured = 6;       // at least: then two opposite ones are among them
  constexpr double kSteepest = 1.0;  // slope of a surface that is no edge and not seen at a slant
  constexpr double kSigmas = 5.0;    // between the nearest and the farthest of the neighbours
  constexpr int kAcrossU[4] = {1, 0, 1, 1};
  constexpr int kAcrossV[4] = {0, 1, 1, -1};
  int measured = 0;
  float low_mm = 3.0e38f;
  float high_mm = 0.0f;
  double sum_mm = 0.0;  // of neighbours on opposite sides, where both are measured
  int paired = 0;
  RP_UNROLL
  for (int i = 0; i < 4; ++i) {
    const float before = read(u - kAcrossU[i], v - kAcrossV[i]);
    const float after = read(u + kAcrossU[i], v + kAcrossV[i]);
    RP_UNROLL
    for (int side = 0; side < 2; ++side) {
      const float one = side == 0 ? before : after;
      if (one == 0.0f) continue;
      ++measured;
      low_mm = one < low_mm ? one : low_mm;
      high_mm = one > high_mm ? one : high_mm;
    }
    if (before == 0.0f || after == 0.0f) continue;
    sum_mm += static_cast<double>(after) + static_cast<double>(before);
    paired += 2;
  }
  if (measured < kMeasured) return 0.0f;
  const double apart_mm = 2.0 * 1.4142135623730951 * camera.pixelSpacingMm(low_mm);
  const double most_mm = kSteepest * apart_mm + kSigmas * noise_mm;
  if (static_cast<double>(high_mm - low_mm) > most_mm) return 0.0f;
  return static_cast<float>(sum_mm / paired);
}

}  // namespace rangepose
