// The four sums of Eq. 2 for one reference pixel (paper Sect. 6.2).
// Twin of errorOfPixel in src/stages/error_core.h.
//
// Texel: cover_sum, cover_count, range_sum, range_weight.
uniform sampler2D u_atlas;
uniform sampler2D u_scene_range;
uniform sampler2D u_scene_distance;
uniform int u_size;                  // of a tile [px]
uniform float u_max_shift;           // [px]
uniform float u_outside_distance;    // of what lies outside of the window [px]
uniform float u_range_limit;         // [px]
uniform int u_holes;                 // HolePolicy
uniform int u_row_step;              // other rows of a tile are left out

flat in highp ivec2 v_tile;
flat in highp vec3 v_translation;
layout(location = 0) out highp vec4 o_terms;

const int kHolePaper = 0;
const int kHoleIgnore = 1;
const int kHoleLimit = 2;

void main() {
  o_terms = vec4(0.0);
  bool reachable = abs(v_translation.x) <= u_max_shift && abs(v_translation.y) <= u_max_shift;
  if (!reachable) return;
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if ((pixel.y - v_tile.y) % u_row_step != 0) return;
  vec4 reference = texelFetch(u_atlas, pixel, 0);
  if (reference.a <= 0.0) return;
  ivec2 window = textureSize(u_scene_range, 0);
  ivec2 shift = ivec2(floor(v_translation.xy + 0.5));
  ivec2 at = pixel - v_tile + (window - u_size) / 2 + shift;
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, window));
  float scene_range = inside ? texelFetch(u_scene_range, at, 0).r : 0.0;
  float scene_distance = inside ? texelFetch(u_scene_distance, at, 0).r : u_outside_distance;
  if (reference.r > 0.0) o_terms.xy = vec2(abs(scene_distance - reference.r), 1.0);
  float predicted = reference.g + (v_translation.z - float(u_size));
  float gap = min(abs(scene_range - predicted), u_range_limit);
  float weight = reference.a;
  if (scene_range == 0.0) {
    if (u_holes == kHolePaper) gap = 0.0;
    if (u_holes == kHoleIgnore) weight = 0.0;
    if (u_holes == kHoleLimit) gap = u_range_limit;
  }
  o_terms.zw = vec2(weight * gap, weight);
}
