// The four sums of Eq. 2 for a block of reference pixels (paper Sect. 6.2): their errors, and the
// first steps of the reduction in one, since writing an error and reading it again takes longer
// than finding it. Twin of errorOfPixel in src/stages/error_core.h.
//
// Texel: cover_sum, cover_count, range_sum, range_weight.
uniform sampler2D u_atlas;
uniform sampler2D u_window;  // range and distance, see frame_window.frag
uniform int u_origin;        // column and row there of a tile's pixel (0, 0), not shifted
uniform int u_size;          // of a tile [px]
uniform float u_max_shift;   // [px]
uniform vec3 u_range_rule;   // RangeRule: limit [px], gap over a hole [px], factor of its weight

flat in highp ivec2 v_tile;
flat in highp ivec2 v_tile_index;
flat in highp vec3 v_translation;
layout(location = 0) out highp vec4 o_terms;

const int kBlock = 4;  // pixels along a side: a texel of level 2

vec4 errorOfPixel(vec4 reference, vec2 scene, float shift_z) {
  bool hole = scene.r == 0.0;
  float off = min(abs(scene.r - (reference.g + shift_z)), u_range_rule.x);
  float gap = hole ? u_range_rule.y : off;
  float weight = hole ? reference.a * u_range_rule.z : reference.a;
  vec2 cover = reference.r > 0.0 ? vec2(abs(scene.g - reference.r), 1.0) : vec2(0.0);
  return vec4(cover, weight * gap, weight);
}

void main() {
  o_terms = vec4(0.0);
  bool reachable = abs(v_translation.x) <= u_max_shift && abs(v_translation.y) <= u_max_shift;
  if (!reachable) return;
  ivec2 first = (ivec2(gl_FragCoord.xy) - v_tile) * kBlock;
  ivec2 in_atlas = v_tile_index * u_size + first;
  ivec2 in_window = first + u_origin + ivec2(floor(v_translation.xy + 0.5));
  ivec2 rest = u_size - first;  // the next tile begins there
  float shift_z = v_translation.z - float(u_size);
  // Blocks begin at even rows. What is background weighs nothing.
  for (int y = 0; y < kBlock; y += RP_ROW_STEP) {
    for (int x = 0; x < kBlock; ++x) {
      ivec2 step = ivec2(x, y);
      vec4 reference = texelFetch(u_atlas, in_atlas + step, 0);
      if (x >= rest.x || y >= rest.y) reference = vec4(0.0);
      o_terms += errorOfPixel(reference, texelFetch(u_window, in_window + step, 0).rg, shift_z);
    }
  }
}
