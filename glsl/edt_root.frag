// Signed distance to the nearest edge [px]. Twin of host::distance.
uniform sampler2D u_texels;
layout(location = 0) out highp float o_distance;

void main() { o_distance = edtDistance(texelFetch(u_texels, ivec2(gl_FragCoord.xy), 0)); }
