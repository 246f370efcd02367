// A mesh as a camera sees it, with the normal of each face.
layout(location = 0) in highp vec3 i_position;  // [mm]
layout(location = 1) in highp vec3 i_normal;    // of the face, unit length

uniform mat3 u_rotation;       // camera_from_object
uniform vec3 u_translation;    // [mm]
// Perspective: window px = xy * point.xy / point.z + zw; else xy * point.xy + zw.
uniform vec4 u_projection;
uniform vec2 u_depth_range;    // nearest and farthest z [mm]
uniform vec2 u_window_size;    // [px]
uniform int u_orthographic;

flat out highp vec3 v_normal;  // in the camera frame, turned towards the camera
out highp float v_depth_mm;

void main() {
  vec3 point = u_rotation * i_position + u_translation;
  vec3 normal = u_rotation * i_normal;
  vec3 ray = u_orthographic != 0 ? vec3(0.0, 0.0, 1.0) : point;
  v_normal = dot(normal, ray) > 0.0 ? -normal : normal;
  v_depth_mm = point.z;
  float near = u_depth_range.x;
  float far = u_depth_range.y;
  // Window pixel (i, j) has its centre at (i + 0.5, j + 0.5), camera pixel (u, v) at (u, v).
  if (u_orthographic != 0) {
    vec2 window = u_projection.xy * point.xy + u_projection.zw + 0.5;
    float depth = (point.z - near) / (far - near);
    gl_Position = vec4(2.0 * window / u_window_size - 1.0, 2.0 * depth - 1.0, 1.0);
  } else {
    vec2 window = u_projection.xy * point.xy + (u_projection.zw + 0.5) * point.z;
    float depth = far * (point.z - near) / (far - near);
    gl_Position = vec4(2.0 * window / u_window_size - point.z, 2.0 * depth - point.z, point.z);
  }
}
