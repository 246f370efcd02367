// 3x3 median; pixels outside repeat the border. Twin of host::median.
uniform sampler2D u_range;
flat in highp ivec4 v_bounds;
layout(location = 0) out highp float o_range;

void order(inout float low, inout float high) {
  float smaller = min(low, high);
  high = max(low, high);
  low = smaller;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float p[9];
  for (int i = 0; i < 9; ++i) {
    ivec2 near = pixel + ivec2(i % 3 - 1, i / 3 - 1);
    p[i] = texelFetch(u_range, clamp(near, v_bounds.xy, v_bounds.zw - 1), 0).r;
  }
  // Forgetful selection: of n + 2 values left, the smallest and the largest cannot be the median.
  order(p[0], p[3]); order(p[1], p[4]); order(p[2], p[5]);
  order(p[0], p[1]); order(p[0], p[2]); order(p[4], p[5]); order(p[3], p[5]);
  order(p[1], p[2]); order(p[3], p[4]); order(p[1], p[3]); order(p[1], p[6]);
  order(p[4], p[6]); order(p[2], p[6]); order(p[2], p[3]); order(p[4], p[7]);
  order(p[2], p[4]); order(p[3], p[7]); order(p[4], p[8]); order(p[3], p[8]);
  order(p[3], p[4]);
  o_range = p[4];
}
