// Passes the fragments whose label changed, for an occlusion query.
uniform highp isampler2D u_previous;
uniform highp isampler2D u_current;
layout(location = 0) out highp int o_label;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  o_label = texelFetch(u_current, pixel, 0).r;
  if (o_label == texelFetch(u_previous, pixel, 0).r) discard;
}
