// Range and |cos(view, normal)| of the nearest face, in the channels that a reference has them in.
flat in highp float v_cosine;
in highp float v_range;
layout(location = 0) out highp vec4 o_texel;

// A pixel that shows the object is told from background by its cosine.
const float kEdgeOn = 1.0e-4;

void main() { o_texel = vec4(0.0, v_range, 0.0, max(v_cosine, kEdgeOn)); }
