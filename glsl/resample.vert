// Where a measured pixel lands in the orthographic range image: one point a pixel that it covers.
// Twin of src/stages/resample_core.h. Instance = pixel of the footprint.
uniform sampler2D u_depth_mm;        // 0 = no measurement
uniform ivec2 u_first;               // upper left pixel of the part that is read
uniform int u_columns;               // of that part
uniform int u_footprint;             // pixels along a side of the largest footprint
uniform ivec2 u_target_size;
uniform vec4 u_ray;                  // inv_fx, inv_fy, cx, cy
uniform float u_parallel;
uniform vec3 u_row_x;                // rows of ortho_from_camera / pixel_mm
uniform vec3 u_row_y;
uniform vec3 u_row_z;
uniform vec3 u_translation;
uniform float u_footprint_per_mm;

flat out highp float v_range;

const float kMaxFootprint = 8.0;

void main() {
  ivec2 pixel = u_first + ivec2(gl_VertexID % u_columns, gl_VertexID / u_columns);
  ivec2 part = ivec2(gl_InstanceID % u_footprint, gl_InstanceID / u_footprint);
  float depth = texelFetch(u_depth_mm, pixel, 0).r;
  float reach = u_parallel != 0.0 ? 1.0 : depth;
  RP_PRECISE float x = (float(pixel.x) - u_ray.z) * u_ray.x * reach;
  RP_PRECISE float y = (float(pixel.y) - u_ray.w) * u_ray.y * reach;
  RP_PRECISE float px = u_row_x.x * x + u_row_x.y * y + u_row_x.z * depth + u_translation.x;
  RP_PRECISE float py = u_row_y.x * x + u_row_y.y * y + u_row_y.z * depth + u_translation.y;
  RP_PRECISE float pz = u_row_z.x * x + u_row_z.y * y + u_row_z.z * depth + u_translation.z;
  RP_PRECISE float count = clamp(ceil(u_footprint_per_mm * reach), 1.0, kMaxFootprint);
  RP_PRECISE float shift = 0.5 * (count - 1.0) - 0.5;
  RP_PRECISE float left = floor(px - shift);
  RP_PRECISE float top = floor(py - shift);
  vec2 target = vec2(left, top) + vec2(part);
  vec2 size = vec2(u_target_size);
  v_range = pz;
  gl_PointSize = 1.0;
  bool drawn = depth != 0.0 && pz > 0.0 && all(lessThan(vec2(part), vec2(count))) &&
               all(greaterThanEqual(target, vec2(0.0))) && all(lessThan(target, size));
  // Outside of the clip volume where nothing is drawn.
  gl_Position = drawn ? vec4(2.0 * (target + 0.5) / size - 1.0, 0.0, 1.0)
                      : vec4(2.0, 2.0, 2.0, 1.0);
}
