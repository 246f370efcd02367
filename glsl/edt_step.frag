// One pass of the signed distance transform (paper Sect. 5.2, Algorithm 1).
// Twin of edtStep in src/stages/edt_core.h: same neighbour order, same strict `<`.
uniform sampler2D u_previous;
flat in highp ivec4 v_bounds;
layout(location = 0) out highp vec4 o_texel;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 best = texelFetch(u_previous, pixel, 0);
  float side = best.z < 0.0 ? -1.0 : 1.0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      ivec2 at = pixel + ivec2(dx, dy);
      if (any(lessThan(at, v_bounds.xy)) || any(greaterThanEqual(at, v_bounds.zw))) continue;
      vec4 near = texelFetch(u_previous, at, 0);
      if (near.w == 0.0) continue;
      vec2 gap = near.xy - vec2(pixel);
      float sq = gap.x * gap.x + gap.y * gap.y;
#ifdef RP_FAULT
      // A deliberate fault: the last site wins a tie. Tests define it to see that they notice.
      if (sq <= side * best.z) best = vec4(near.xy, side * sq, 1.0);
#else
      if (sq < side * best.z) best = vec4(near.xy, side * sq, 1.0);
#endif
    }
  }
  o_texel = best;
}
