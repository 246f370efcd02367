// Start of the pixel grouping (paper Sect. 5.3): every pixel of a surface is its own patch.
uniform sampler2D u_range;
uniform sampler2D u_edges;
uniform int u_width;
layout(location = 0) out highp int o_label;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  bool inside = texelFetch(u_range, pixel, 0).r != 0.0 && texelFetch(u_edges, pixel, 0).r == 0.0;
  o_label = inside ? pixel.y * u_width + pixel.x : -1;
}
