// One quad a view over the box of its object, in its tile; nothing for a view whose search is over.
//
// Level 0 is the atlas (tiles of u_size px); a tile of level k holds the sums of 2^k x 2^k pixels.
layout(location = 0) in highp ivec4 i_box;  // in the tile of level 0: x0, y0, x1, y1 [px]

uniform sampler2D u_state;
uniform ivec2 u_target_size;
uniform int u_columns;  // tiles in a row
uniform int u_size;     // of a tile of level 0 [px]
uniform int u_level;

flat out highp ivec2 v_tile;          // origin of the tile in the target [px]
flat out highp ivec2 v_tile_index;    // column and row of the tile
flat out highp vec3 v_translation;    // [px]

void main() {
  vec3 translation = texelFetch(u_state, ivec2(gl_InstanceID, kRowCandidate), 0).xyz;
  int phase = int(texelFetch(u_state, ivec2(gl_InstanceID, kRowCounters), 0).x);
  int round_up = (1 << u_level) - 1;
  int pitch = (u_size + round_up) >> u_level;
  ivec2 low = i_box.xy >> u_level;
  ivec2 high = (i_box.zw + round_up) >> u_level;
  v_tile_index = ivec2(gl_InstanceID % u_columns, gl_InstanceID / u_columns);
  v_tile = v_tile_index * pitch;
  v_translation = translation;
  ivec2 corner = v_tile + ivec2((gl_VertexID & 1) != 0 ? high.x : low.x,
                                (gl_VertexID & 2) != 0 ? high.y : low.y);
  bool drawn = phase != kDone && all(lessThan(i_box.xy, i_box.zw));
  gl_Position = drawn ? vec4(2.0 * vec2(corner) / vec2(u_target_size) - 1.0, 0.0, 1.0)
                      : vec4(2.0, 2.0, 2.0, 1.0);
}
