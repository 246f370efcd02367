// Texel: xyz unit normal of the face seen, w depth along z [mm].
flat in highp vec3 v_normal;
in highp float v_depth_mm;
layout(location = 0) out highp vec4 o_surface;

void main() { o_surface = vec4(normalize(v_normal), v_depth_mm); }
