// One pass of the log-step reduction (paper Fig. 9). The targets shrink: the paper keeps the size and
// adds a pixel, its right, its lower and its diagonal neighbour at distances 1, 2, 4, ..., but only
// every second, fourth, ... pixel of its sums is ever read. Two of its steps in one, since a draw of
// few pixels takes as long as one of many.
uniform sampler2D u_previous;
uniform int u_previous_pitch;  // width of a tile of the previous level [px]
uniform int u_step;            // 2^u_step x 2^u_step texels are added

flat in highp ivec2 v_tile;
flat in highp ivec2 v_tile_index;
layout(location = 0) out highp vec4 o_terms;

void main() {
  ivec2 first = (ivec2(gl_FragCoord.xy) - v_tile) << u_step;
  // The next tile begins at the pitch.
  ivec2 last = min(first + (1 << u_step), ivec2(u_previous_pitch));
  ivec2 tile = v_tile_index * u_previous_pitch;
  o_terms = vec4(0.0);
  for (int y = first.y; y < last.y; ++y) {
    for (int x = first.x; x < last.x; ++x) {
      o_terms += texelFetch(u_previous, tile + ivec2(x, y), 0);
    }
  }
}
