// Range of a splat; the depth test keeps the nearest one.
flat in highp float v_range;
layout(location = 0) out highp float o_range;

void main() {
  o_range = v_range;
  // A power of two: scaling is exact, so no two ranges fall together.
  gl_FragDepth = v_range * (1.0 / 1048576.0);
}
