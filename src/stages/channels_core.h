// One pixel of the 3x3 median and of the edge image (paper Sect. 5.1). Shared by host and CUDA.
// Twins: glsl/median.frag, glsl/edges.frag.
#pragma once

#include "core/host_device.h"
#include "stages/lanes.h"

namespace rangepose {

namespace channels_detail {

RP_HD void order(float& low, float& high) {
  const float least = smaller(low, high);
  high = larger(low, high);
  low = least;
}

}  // namespace channels_detail

/// Median of nine by a sorting network without branches, so that the host's row loop vectorises
/// (Paeth 1990, "Median finding on a 3x3 grid"). Leaves `p` in some other order.
RP_HD float medianOfNine(float (&p)[9]) {
  using namespace channels_detail;
  order(p[1], p[2]);
  order(p[4], p[5]);
  order(p[7], p[8]);
  order(p[0], p[1]);
  order(p[3], p[4]);
  order(p[6], p[7]);
  order(p[1], p[2]);
  order(p[4], p[5]);
  order(p[7], p[8]);
  p[3] = larger(p[0], p[3]);
  p[5] = smaller(p[5], p[8]);
  order(p[4], p[7]);
  p[6] = larger(p[3], p[6]);
  p[4] = larger(p[1], p[4]);
  p[2] = smaller(p[2], p[5]);
  p[4] = smaller(p[4], p[7]);
  order(p[4], p[2]);
  p[4] = larger(p[6], p[4]);
  return smaller(p[4], p[2]);
}

/// How the range changes at the middle of nine pixels.
inline constexpr float kLevel = 0.0f;  ///< no neighbour is farther than the threshold; background
inline constexpr float kSteep = 1.0f;  ///< one is, on a slope that goes on across the pixel
inline constexpr float kJump = 2.0f;   ///< one is, by more than the threshold more than across

RP_HD float stepOfNine(const float (&p)[9], float threshold_px) {
  using namespace channels_detail;
  const float here = p[4];
  float farthest = 0.0f;
  float uneven = 0.0f;
  for (int i = 0; i < 4; ++i) {
    const float before = p[i] - here;
    const float after = p[8 - i] - here;
    const float most = larger(magnitude(before), magnitude(after));
    farthest = larger(farthest, most);
    uneven = larger(uneven, smaller(most, magnitude(before + after)));
  }
  const float steep = farthest > threshold_px ? kSteep : kLevel;
  const float step = uneven > threshold_px ? kJump : steep;
  return here != 0.0f ? step : kLevel;
}

/// 1 where the steps of nine pixels make the middle one an edge: it is a jump, or steep beside one.
/// Differs from the paper, which takes all that is steep: there a slanted face is nothing but
/// edges, and a plate so seen has no inside to start from or to compare. What is steep beside a
/// jump is where a sensor smears it.
RP_HD float edgeOfSteps(const float (&steps)[9]) {
  float most = 0.0f;
  for (int i = 0; i < 9; ++i) most = larger(most, steps[i]);
  return steps[4] != kLevel && most == kJump ? 1.0f : 0.0f;
}

}  // namespace rangepose
