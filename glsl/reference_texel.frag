// A texel of the atlas (paper Sect. 4.1): distance to the nearest edge, range, edge, cosine.
uniform sampler2D u_surface;
uniform sampler2D u_edges;
uniform sampler2D u_distances;
layout(location = 0) out highp vec4 o_texel;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(u_surface, pixel, 0);
  float edge = texelFetch(u_edges, pixel, 0).r;
  float distance_px = edtDistance(texelFetch(u_distances, pixel, 0));
  o_texel = vec4(distance_px, surface.g, edge, surface.a);
}
