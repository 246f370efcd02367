// 1 where the range jumps (paper Sect. 5.1), see stepOfNine and edgeOfSteps. Twin of host::edges.
uniform sampler2D u_range;
uniform float u_threshold_px;
flat in highp ivec4 v_bounds;
layout(location = 0) out highp float o_edge;

#ifndef RP_RANGE
#define RP_RANGE r
#endif

const int kLevel = 0;
const int kSteep = 1;
const int kJump = 2;

ivec2 inside(ivec2 pixel) { return clamp(pixel, v_bounds.xy, v_bounds.zw - 1); }

float rangeAt(ivec2 pixel) { return texelFetch(u_range, inside(pixel), 0).RP_RANGE; }

int stepAt(ivec2 pixel) {
  float here = rangeAt(pixel);
  if (here == 0.0) return kLevel;
  float farthest = 0.0;
  float uneven = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 aside = i == 3 ? ivec2(-1, 0) : ivec2(i - 1, -1);
    float before = rangeAt(pixel + aside) - here;
    float after = rangeAt(pixel - aside) - here;
    float most = max(abs(before), abs(after));
    farthest = max(farthest, most);
    uneven = max(uneven, min(most, abs(before + after)));
  }
  return uneven > u_threshold_px ? kJump : farthest > u_threshold_px ? kSteep : kLevel;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  // Most pixels are level, most others jumps: few need their neighbours.
  int most = stepAt(pixel);
  if (most == kSteep) {
    for (int i = 0; i < 9; ++i) most = max(most, stepAt(inside(pixel + ivec2(i % 3 - 1, i / 3 - 1))));
  }
  o_edge = most == kJump ? 1.0 : 0.0;
}
