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
  float jump = 0.0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      ivec2 near = clamp(pixel + ivec2(dx, dy), v_bounds.xy, v_bounds.zw - 1);
      jump = max(jump, abs(texelFetch(u_range, near, 0).RP_RANGE - here));
    }
  }
  o_edge = here != 0.0 && jump > u_threshold_px ? 1.0 : 0.0;
}
