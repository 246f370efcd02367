// Many views of a mesh at once, one an instance, each into its tile (paper Sect. 4.1).
layout(location = 0) in highp vec3 i_position;  // [mm]
layout(location = 1) in highp vec3 i_normal;    // of the face, unit length
// Rows of the transform to (column, row) of the target and range [px]; w is the offset.
layout(location = 2) in highp vec4 i_to_column;
layout(location = 3) in highp vec4 i_to_row;
layout(location = 4) in highp vec4 i_to_range;

uniform vec2 u_target_size;
uniform float u_size;  // of a tile [px]; ranges lie in (0, 2 * u_size)

flat out highp float v_cosine;
out highp float v_range;

void main() {
  vec4 point = vec4(i_position, 1.0);
  vec2 window = vec2(dot(i_to_column, point), dot(i_to_row, point));
  v_range = dot(i_to_range, point);
  v_cosine = abs(dot(normalize(i_to_range.xyz), i_normal));
  gl_Position = vec4(2.0 * window / u_target_size - 1.0, v_range / u_size - 1.0, 1.0);
}
