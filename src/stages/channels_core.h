// One pixel of the 3x3 median and of the edge image (paper Sect. 5.1). Shared by host and CUDA.
// Twins: glsl/median.frag, glsl/edges.frag.
#pragma once

#include "stages/device.h"

namespace rangepose {

namespace channels_detail {

RP_HD float smaller(float a, float b) { return b < a ? b : a; }
RP_HD float larger(float a, float b) { return a < b ? b : a; }
RP_HD float magnitude(float a) { return a < 0.0f ? -a : a; }
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

/// 1 where the middle of the nine, p[4], is no background and the range jumps there: by more than
/// the threshold to one side, and by more than the threshold more than to the side across. Differs
/// from the paper, which asks for the jump alone: there a steep face is nothing but edges, and a
/// plate seen at a slant has no inside that could be compared.
RP_HD float edgeOfNine(const float (&p)[9], float threshold_px) {
  using namespace channels_detail;
  const float here = p[4];
  float most = 0.0f;
  for (int i = 0; i < 4; ++i) {
    const float before = p[i] - here;
    const float after = p[8 - i] - here;
    const float jump = larger(magnitude(before), magnitude(after));
    most = larger(most, smaller(jump, magnitude(before + after)));
  }
  return here != 0.0f && most > threshold_px ? 1.0f : 0.0f;
}

}  // namespace rangepose
