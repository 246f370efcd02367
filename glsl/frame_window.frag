// A scene window with background around it: range and distance in one texel, so that the search
// fetches once and asks nowhere whether a pixel lies inside. Twin of frameWindow in cuda/.
uniform sampler2D u_scene_range;
uniform sampler2D u_scene_distance;
uniform int u_pad;                   // background on each side [px]
uniform float u_outside_distance;    // of what lies outside of the window [px]

layout(location = 0) out highp vec2 o_texel;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) - u_pad;
  bool inside = all(greaterThanEqual(at, ivec2(0))) &&
                all(lessThan(at, textureSize(u_scene_range, 0)));
  o_texel = inside ? vec2(texelFetch(u_scene_range, at, 0).r,
                          texelFetch(u_scene_distance, at, 0).r)
                   : vec2(0.0, u_outside_distance);
}
