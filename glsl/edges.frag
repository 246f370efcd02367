// 1 where the range jumps (paper Sect. 5.1). Twin of host::edges.
uniform sampler2D u_range;
uniform float u_threshold_px;
flat in highp ivec4 v_bounds;
layout(location = 0) out highp float o_edge;

#ifndef RP_RANGE
#define RP_RANGE r
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float here = texelFetch(u_range, pixel, 0).RP_RANGE;
  // A slope goes on across the pixel; a jump does not.
  float most = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 aside = i == 3 ? ivec2(-1, 0) : ivec2(i - 1, -1);
    ivec2 low = clamp(pixel + aside, v_bounds.xy, v_bounds.zw - 1);
    ivec2 high = clamp(pixel - aside, v_bounds.xy, v_bounds.zw - 1);
    float before = texelFetch(u_range, low, 0).RP_RANGE - here;
    float after = texelFetch(u_range, high, 0).RP_RANGE - here;
    most = max(most, min(max(abs(before), abs(after)), abs(before + after)));
  }
  o_edge = here != 0.0 && most > u_threshold_px ? 1.0 : 0.0;
}
