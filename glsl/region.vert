// Quads over rectangles of the target, one an instance. The corners are made from gl_VertexID.
layout(location = 0) in highp ivec4 i_box;     // drawn: x0, y0, x1, y1 [px]
layout(location = 1) in highp ivec4 i_bounds;  // neighbours outside of it do not exist

uniform ivec2 u_target_size;

flat out highp ivec4 v_bounds;

void main() {
  ivec2 corner = ivec2((gl_VertexID & 1) != 0 ? i_box.z : i_box.x,
                       (gl_VertexID & 2) != 0 ? i_box.w : i_box.y);
  v_bounds = i_bounds;
  gl_Position = vec4(2.0 * vec2(corner) / vec2(u_target_size) - 1.0, 0.0, 1.0);
}
