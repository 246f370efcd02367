// One pass of the log-step reduction (paper Fig. 9): a pixel, its right, its lower and its diagonal
// neighbour. The targets shrink: the paper keeps the size and adds at distances 1, 2, 4, ..., but
// only every second, fourth, ... pixel of its sums is ever read. The sums are the same.
uniform sampler2D u_previous;
uniform int u_previous_pitch;  // width of a tile of the previous level [px]

flat in highp ivec2 v_tile;
flat in highp ivec2 v_tile_index;
layout(location = 0) out highp vec4 o_terms;

vec4 read(ivec2 in_tile) {
  // An odd tile has no right or lower neighbour at its end: the next tile begins there.
  if (any(greaterThanEqual(in_tile, ivec2(u_previous_pitch)))) return vec4(0.0);
  return texelFetch(u_previous, v_tile_index * u_previous_pitch + in_tile, 0);
}

void main() {
  ivec2 first = 2 * (ivec2(gl_FragCoord.xy) - v_tile);
  o_terms = read(first) + read(first + ivec2(1, 0)) + read(first + ivec2(0, 1)) +
            read(first + ivec2(1, 1));
}
