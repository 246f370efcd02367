// Second differences along a row of depth: what noise is measured by. Shared by host and CUDA.
#pragma once

#include "core/host_device.h"

namespace rangepose {

/// Neighbours of stereo and interpolated images share their noise: points some pixels apart do not.
inline constexpr int kNoiseApart = 3;
/// Every second row is enough.
inline constexpr int kNoiseRowStep = 2;
/// Of fewer triples nothing is said.
inline constexpr int kNoiseFewest = 100;

/// |a - 2 b + c| of the depths [mm] at u - 3, u and u + 3, at least 0; below 0 where one of them
/// was not measured.
RP_HD float secondDifference(float left_mm, float middle_mm, float right_mm) {
  if (left_mm == 0.0f || middle_mm == 0.0f || right_mm == 0.0f) return -1.0f;
  const float difference = left_mm - 2.0f * middle_mm + right_mm;
  return difference < 0.0f ? -difference : difference + 0.0f;
}

/// Standard deviation of the noise [mm] of which the `count` smallest second differences, the lower
/// half, have that sum. For x from N(0, s^2) the mean of the lower half of |x| is 0.3247 s, and of
/// second differences s is sqrt(6) sigma.
RP_HD double noiseOfLowerHalf(double sum_mm, double count) {
  return sum_mm / count / (0.3247 * 2.449489742783178);
}

}  // namespace rangepose
