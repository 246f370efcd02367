#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "stages/simd.h"
#include "stages/surface.h"

namespace rangepose {

namespace {

/// Bounds of the projection of a box around a sphere, in pixels: a little larger than those of the
/// sphere.
struct Bounds {
  glm::dvec2 low{std::numeric_limits<double>::max()};
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
};

Bounds projectedBounds(const Camera& camera, const glm::dvec3& center_mm, double radius_mm) {
  Bounds bounds;
  if (!camera.orthographic && center_mm.z - radius_mm <= 0.0) return bounds;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 sign(
        (corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    const glm::dvec2 pixel = camera.project(center_mm + radius_mm * sign);
    bounds.low = glm::min(bounds.low, pixel);
    bounds.high = glm::max(bounds.high, pixel);
  }
  return bounds;
}

Bounds clipped(const Bounds& bounds, const Camera& camera) {
  return {glm::max(bounds.low, glm::dvec2(0.0)),
          glm::min(bounds.high, glm::dvec2(camera.width - 1, camera.height - 1))};
}

bool isEmpty(const Bounds& bounds) {
  return !(bounds.low.x <= bounds.high.x) || !(bounds.low.y <= bounds.high.y);
}

SurfaceWindow windowOf(const Bounds& bounds, int max_pixels) {
  SurfaceWindow window;
  if (isEmpty(bounds)) return window;
  // A part so near that it fills many images is not rendered finer for it.
  constexpr double kFarthestPx = 1.0e6;
  const glm::dvec2 low = glm::max(bounds.low, glm::dvec2(-kFarthestPx));
  const glm::dvec2 high = glm::min(bounds.high, glm::dvec2(kFarthestPx));
  window.x0 = static_cast<int>(std::floor(low.x));
  window.y0 = static_cast<int>(std::floor(low.y));
  const int width = static_cast<int>(std::ceil(high.x)) - window.x0 + 1;
  const int height = static_cast<int>(std::ceil(high.y)) - window.y0 + 1;
  window.step = std::max(1, (std::max(width, height) + max_pixels - 1) / max_pixels);
  window.width = (width + window.step - 1) / window.step;
  window.height = (height + window.step - 1) / window.step;
  return window;
}

}  // namespace

SurfaceWindow windowAround(const Camera& camera,
                           const glm::dvec3& center_mm,
                           double radius_mm,
                           int max_pixels) {
  return windowOf(clipped(projectedBounds(camera, center_mm, radius_mm), camera), max_pixels);
}

SurfaceWindow wholeWindowAround(const Camera& camera,
                                const glm::dvec3& center_mm,
                                double radius_mm,
                                int max_pixels) {
  const Bounds bounds = projectedBounds(camera, center_mm, radius_mm);
  if (isEmpty(clipped(bounds, camera))) return {};
  return windowOf(bounds, max_pixels);
}

namespace host {
namespace {

/// A mesh as a camera sees it, vertex by vertex.
struct ScreenMesh {
  std::vector<glm::dvec3> points_mm;  ///< in the camera frame
  std::vector<glm::dvec2> pixels;     ///< in the window
  /// Pixel centres from `xy` on are not left of or above the vertex, those up to `zw` not right of
  /// or below it.
  std::vector<glm::ivec4> between;
  bool in_front = true;  ///< all of it
};

/// Triangles that reach nearer than this are left out.
constexpr double kNearestMm = 1.0;

/// Rounded down; where the sum is rounded, up, which only looks at a pixel more. The conversion
/// cuts off towards zero, which far above zero is down.
RP_ALWAYS_INLINE int floorOf(double value) {
  constexpr int kAbove = 1 << 24;
  return static_cast<int>(value + kAbove) - kAbove;
}

/// Far outside of any image it stays there.
RP_ALWAYS_INLINE double bounded(double pixel) {
  constexpr double kFar = 1.0e6;
  return std::min(kFar, std::max(-kFar, pixel));
}

RP_SIMD_CLONES
void projectVertices(const Mesh& mesh,
                     const Camera& camera,
                     const Pose& camera_from_object,
                     const SurfaceWindow& window,
                     ScreenMesh& screen) {
  const glm::dvec2 origin(window.x0, window.y0);
  const double step = window.step;
  const std::size_t count = mesh.vertices.size();
  double nearest_mm = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 point = camera_from_object * glm::dvec3(mesh.vertices[i]);
    const glm::dvec2 pixel = (camera.project(point) - origin) / step;
    const double u = bounded(pixel.x);
    const double v = bounded(pixel.y);
    screen.points_mm[i] = point;
    screen.pixels[i] = pixel;
    screen.between[i] = {-floorOf(-u), -floorOf(-v), floorOf(u), floorOf(v)};
    nearest_mm = std::min(nearest_mm, point.z);
  }
  screen.in_front = camera.orthographic || nearest_mm > kNearestMm;
}

/// Corners of a triangle on the screen.
struct Corners {
  const ScreenMesh& mesh;
  glm::uvec3 at;

  const glm::dvec3& point(int corner) const { return mesh.points_mm[at[corner]]; }
  const glm::dvec2& pixel(int corner) const { return mesh.pixels[at[corner]]; }
  const glm::ivec4& between(int corner) const { return mesh.between[at[corner]]; }
  bool inFront() const { return std::min({point(0).z, point(1).z, point(2).z}) > kNearestMm; }
  /// Not of unit length, outwards where the corners go round it as seen from there.
  glm::dvec3 normal() const { return glm::cross(point(1) - point(0), point(2) - point(0)); }
};

/// Positive to the inner side of an edge of a triangle, linear in the pixel.
struct EdgeLine {
  double by_x;
  double by_y;
  double at_origin;

  EdgeLine(const glm::dvec2& from, const glm::dvec2& to, double sign)
      : by_x(sign * (from.y - to.y)),
        by_y(sign * (to.x - from.x)),
        at_origin(-(by_x * from.x + by_y * from.y)) {}
  /// At the row's start; a pixel farther right has `by_x` more.
  double row(double y) const { return by_y * y + at_origin; }
};

/// The depth of a face along the ray of a pixel: one number over another, both linear in the pixel.
class FaceDepth {
 public:
  FaceDepth(const Corners& corners, const Camera& camera, const SurfaceWindow& window)
      : low_z_(std::min({corners.point(0).z, corners.point(1).z, corners.point(2).z})),
        high_z_(std::max({corners.point(0).z, corners.point(1).z, corners.point(2).z})) {
    const glm::dvec3 normal = corners.normal();
    const double offset = glm::dot(normal, corners.point(0));
    const glm::dvec3 corner = camera.unproject(window.x0, window.y0, 1.0);
    const glm::dvec3 next =
        camera.unproject(window.x0 + window.step, window.y0 + window.step, 1.0) - corner;
    const double by_x = normal.x * next.x;
    const double by_y = normal.y * next.y;
    const double here = normal.x * corner.x + normal.y * corner.y;
    if (camera.orthographic) {
      over_ = {-by_x, -by_y, offset - here};
      under_ = {0.0, 0.0, normal.z};
    } else {
      over_ = {0.0, 0.0, offset};
      under_ = {by_x, by_y, here + normal.z};
    }
  }

  /// At pixel (x, y) of the window. A face seen edge on has no stable plane: its corners bound the
  /// depth.
  float at(int x, int y) const {
    const double z = linear(over_, x, y) / linear(under_, x, y);
    // Not "outside", so that a NaN counts as outside too.
    return static_cast<float>(z >= low_z_ ? std::min(z, high_z_) : low_z_);
  }

 private:
  static double linear(const glm::dvec3& factors, double x, double y) {
    return factors.x * x + factors.y * y + factors.z;
  }

  double low_z_;
  double high_z_;
  glm::dvec3 over_{0.0};
  glm::dvec3 under_{0.0};
};

/// What is nearest at a pixel so far.
struct Nearest {
  float depth = std::numeric_limits<float>::max();
  int triangle = -1;
};

/// `backs` of faces are drawn too.
void fillTriangle(const Corners& corners,
                  bool backs,
                  int triangle,
                  const Camera& camera,
                  const SurfaceWindow& window,
                  Image<Nearest>& nearest) {
  // Pixels on an edge belong to both of its triangles: rounding leaves no gap [px^2].
  constexpr double kOnEdge = -1e-9;
  const glm::dvec2 ab = corners.pixel(1) - corners.pixel(0);
  const glm::dvec2 ac = corners.pixel(2) - corners.pixel(0);
  const double area = ab.x * ac.y - ab.y * ac.x;
  if (backs ? area == 0.0 : !(area < 0.0)) return;
  // Most triangles of a fine mesh lie between pixel centres.
  const glm::ivec4& a = corners.between(0);
  const glm::ivec4& b = corners.between(1);
  const glm::ivec4& c = corners.between(2);
  const int x0 = std::max(0, std::min({a.x, b.x, c.x}));
  const int x1 = std::min(window.width - 1, std::max({a.z, b.z, c.z}));
  const int y0 = std::max(0, std::min({a.y, b.y, c.y}));
  const int y1 = std::min(window.height - 1, std::max({a.w, b.w, c.w}));
  if (x0 > x1 || y0 > y1) return;
  const double sign = area > 0.0 ? 1.0 : -1.0;
  const EdgeLine first(corners.pixel(0), corners.pixel(1), sign);
  const EdgeLine second(corners.pixel(1), corners.pixel(2), sign);
  const EdgeLine third(corners.pixel(2), corners.pixel(0), sign);
  // Made when the first pixel is found: most triangles of a fine mesh have none.
  std::optional<FaceDepth> face;
  for (int y = y0; y <= y1; ++y) {
    Nearest* const row = &nearest.at(0, y);
    const double first_row = first.row(y);
    const double second_row = second.row(y);
    const double third_row = third.row(y);
    for (int x = x0; x <= x1; ++x) {
      const double inside = std::min(
          {first_row + first.by_x * x, second_row + second.by_x * x, third_row + third.by_x * x});
      if (inside < kOnEdge) continue;
      if (!face) face.emplace(corners, camera, window);
      const float depth = face->at(x, y);
      if (depth < row[x].depth) row[x] = {depth, triangle};
    }
  }
}

/// The unit normal, turned towards the camera.
glm::vec3 normalTowards(const Camera& camera, const Corners& corners) {
  const glm::dvec3 normal = glm::normalize(corners.normal());
  const glm::dvec3 away = camera.orthographic ? glm::dvec3(0, 0, 1) : corners.point(0);
  return glm::vec3(glm::dot(normal, away) > 0.0 ? -normal : normal);
}

/// Normals only of what is seen, and once for neighbours on one face.
void shade(const Image<Nearest>& nearest,
           const Mesh& mesh,
           const ScreenMesh& screen,
           const Camera& camera,
           Image<SurfaceTexel>& surface) {
  int last = -1;
  glm::vec3 normal(0.0f);
  auto texel = surface.begin();
  for (const Nearest& pixel : nearest) {
    if (pixel.triangle >= 0) {
      if (pixel.triangle != last) {
        last = pixel.triangle;
        normal = normalTowards(camera, {screen, mesh.triangles[static_cast<std::size_t>(last)]});
      }
      *texel = {normal, pixel.depth};
    }
    ++texel;
  }
}

}  // namespace

Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                  const Camera& camera,
                                  const Pose& camera_from_object,
                                  const SurfaceWindow& window) {
  Image<SurfaceTexel> surface(window.width, window.height, SurfaceTexel(0.0f));
  if (surface.empty()) return surface;
  ScreenMesh screen;
  screen.points_mm.resize(mesh.vertices.size());
  screen.pixels.resize(mesh.vertices.size());
  screen.between.resize(mesh.vertices.size());
  projectVertices(mesh, camera, camera_from_object, window, screen);
  // A camera inside of the solid would see its backs.
  const bool backs = !mesh.solid || !screen.in_front;
  Image<Nearest> nearest(window.width, window.height, Nearest{});
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners corners{screen, mesh.triangles[i]};
    if (!screen.in_front && !corners.inFront()) continue;
    fillTriangle(corners, backs, static_cast<int>(i), camera, window, nearest);
  }
  shade(nearest, mesh, screen, camera, surface);
  return surface;
}

}  // namespace host
}  // namespace rangepose
