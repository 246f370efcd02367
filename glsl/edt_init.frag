// Start of the signed distance transform (paper Sect. 5.2, Algorithm 1).
// Twin of edtInit in src/stages/edt_core.h.
//
// Texel: xy nearest edge pixel, z signed squared distance [px^2], w 1 once found.
uniform sampler2D u_range;
uniform sampler2D u_edges;
uniform int u_passes;
layout(location = 0) out highp vec4 o_texel;

#ifndef RP_RANGE
#define RP_RANGE r
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float far = float((u_passes + 1) * (u_passes + 1));
  bool shown = texelFetch(u_range, pixel, 0).RP_RANGE != 0.0;
  bool edge = texelFetch(u_edges, pixel, 0).r != 0.0;
  o_texel = edge ? vec4(vec2(pixel), 0.0, 1.0) : vec4(vec2(pixel), shown ? far : -far, 0.0);
}
