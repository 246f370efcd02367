// One pass of the pixel grouping (paper Sect. 5.3). Twin of host::patches once nothing changes.
//
// A label is the index of a pixel of the same patch and only ever falls. The smallest label of the
// 4-neighbours spreads by one pixel a pass; taking the label of the pixel it names makes it jump.
uniform highp isampler2D u_previous;
uniform int u_width;
flat in highp ivec4 v_bounds;
layout(location = 0) out highp int o_label;

int labelAt(ivec2 at) { return texelFetch(u_previous, at, 0).r; }

int smaller(int label, ivec2 at) {
  if (any(lessThan(at, v_bounds.xy)) || any(greaterThanEqual(at, v_bounds.zw))) return label;
  int near = labelAt(at);
  return near >= 0 ? min(label, near) : label;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int label = labelAt(pixel);
  if (label >= 0) {
    label = smaller(label, pixel + ivec2(0, -1));
    label = smaller(label, pixel + ivec2(-1, 0));
    label = smaller(label, pixel + ivec2(1, 0));
    label = smaller(label, pixel + ivec2(0, 1));
    for (int jump = 0; jump < 4; ++jump) label = labelAt(ivec2(label % u_width, label / u_width));
  }
  o_label = label;
}
