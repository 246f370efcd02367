#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
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
  PixelBox box;          ///< of the window: outside of it there is nothing of the mesh
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
  glm::ivec2 low(window.width, window.height);
  glm::ivec2 high(-1);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 point = camera_from_object * glm::dvec3(mesh.vertices[i]);
    const glm::dvec2 pixel = (camera.project(point) - origin) / step;
    const double u = bounded(pixel.x);
    const double v = bounded(pixel.y);
    screen.points_mm[i] = point;
    screen.pixels[i] = pixel;
    screen.between[i] = {-floorOf(-u), -floorOf(-v), floorOf(u), floorOf(v)};
    nearest_mm = std::min(nearest_mm, point.z);
    low = glm::min(low, glm::ivec2(screen.between[i]));
    high = glm::max(high, glm::ivec2(screen.between[i].z, screen.between[i].w));
  }
  screen.box = {std::max(low.x, 0),
                std::max(low.y, 0),
                std::min(high.x + 1, window.width),
                std::min(high.y + 1, window.height)};
  screen.in_front = camera.orthographic || nearest_mm > kNearestMm;
}

/// Corners of a triangle on the screen.
struct Corners {
  const ScreenMesh& mesh;
  glm::uvec3 at;

  const glm::dvec3& point(int corner) const { return mesh.points_mm[at[corner]]; }
  const glm::dvec2& pixel(int corner) const { return mesh.pixels[at[corner]]; }
  const glm::ivec4& between(int corner) const { return mesh.between[at[corner]]; }
  /// Twice that on the screen; negative where the face is towards the camera [px^2].
  double area() const {
    const glm::dvec2 ab = pixel(1) - pixel(0);
    const glm::dvec2 ac = pixel(2) - pixel(0);
    return ab.x * ac.y - ab.y * ac.x;
  }
  bool inFront() const { return std::min({point(0).z, point(1).z, point(2).z}) > kNearestMm; }
  /// Not of unit length, outwards where the corners go round it as seen from there.
  glm::dvec3 normal() const { return glm::cross(point(1) - point(0), point(2) - point(0)); }
};

/// Four pixels of a row at a time.
using Double4 = double __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));
constexpr int kAcross = 4;

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

/// Where the rays of a window's pixels pass at a depth of 1 mm.
struct PixelRays {
  glm::dvec3 corner;  ///< that of its first pixel [mm]
  glm::dvec3 next;    ///< from one pixel to the next [mm]
  bool parallel;

  PixelRays(const Camera& camera, const SurfaceWindow& window)
      : corner(camera.unproject(window.x0, window.y0, 1.0)),
        next(camera.unproject(window.x0 + window.step, window.y0 + window.step, 1.0) - corner),
        parallel(camera.orthographic) {}
};

/// The depth of a face along the ray of a pixel: one number over another, both linear in the pixel.
class FaceDepth {
 public:
  RP_ALWAYS_INLINE FaceDepth(const Corners& corners, const PixelRays& rays)
      : low_z_(std::min({corners.point(0).z, corners.point(1).z, corners.point(2).z})),
        high_z_(std::max({corners.point(0).z, corners.point(1).z, corners.point(2).z})) {
    const glm::dvec3 normal = corners.normal();
    const double offset = glm::dot(normal, corners.point(0));
    const double by_x = normal.x * rays.next.x;
    const double by_y = normal.y * rays.next.y;
    const double here = normal.x * rays.corner.x + normal.y * rays.corner.y;
    if (rays.parallel) {
      over_ = {-by_x, -by_y, offset - here};
      under_ = {0.0, 0.0, normal.z};
    } else {
      over_ = {0.0, 0.0, offset};
      under_ = {by_x, by_y, here + normal.z};
    }
  }

  /// At pixels (x, y) of the window. A face seen edge on has no stable plane: its corners bound the
  /// depth.
  RP_ALWAYS_INLINE Float4 at(const Double4& x, double y) const {
    const Double4 z = linear(over_, x, y) / linear(under_, x, y);
    const Double4 below = z < high_z_ ? z : Double4{} + high_z_;
    // Not "outside", so that a NaN counts as outside too.
    return __builtin_convertvector(z >= low_z_ ? below : Double4{} + low_z_, Float4);
  }

 private:
  RP_ALWAYS_INLINE static Double4 linear(const glm::dvec3& factors, const Double4& x, double y) {
    return factors.x * x + factors.y * y + factors.z;
  }

  double low_z_;
  double high_z_;
  glm::dvec3 over_{0.0};
  glm::dvec3 under_{0.0};
};

/// What is nearest at each pixel of a box so far. Rows are a few pixels longer than the box, so
/// that four pixels are always there.
class Nearest {
 public:
  explicit Nearest(const PixelBox& box)
      : box_(box),
        depth_(box.width() + kAcross, box.height(), std::numeric_limits<float>::max()),
        triangle_(box.width() + kAcross, box.height(), kNone) {}

  static constexpr int kNone = -1;

  const PixelBox& box() const { return box_; }
  float depth(int x, int y) const { return depth_.at(x - box_.x0, y - box_.y0); }
  int triangle(int x, int y) const { return triangle_.at(x - box_.x0, y - box_.y0); }

  /// At four pixels from (x, y) on, where `inside`.
  RP_ALWAYS_INLINE void draw(int x, int y, const Int4& inside, const Float4& depth, int triangle) {
    float* const depths = &depth_.at(x - box_.x0, y - box_.y0);
    int* const triangles = &triangle_.at(x - box_.x0, y - box_.y0);
    Float4 before;
    Int4 drawn;
    std::memcpy(&before, depths, sizeof before);
    std::memcpy(&drawn, triangles, sizeof drawn);
    const Int4 nearer = inside & (depth < before);
    before = nearer ? depth : before;
    drawn = nearer ? Int4{} + triangle : drawn;
    std::memcpy(depths, &before, sizeof before);
    std::memcpy(triangles, &drawn, sizeof drawn);
  }

 private:
  PixelBox box_;
  Image<float> depth_;
  Image<int> triangle_;
};

RP_ALWAYS_INLINE Double4 lower(const Double4& a, const Double4& b) { return a < b ? a : b; }

/// A triangle that may cover pixel centres, and a box that holds these.
struct Drawn {
  int triangle;
  PixelBox box;
};

RP_ALWAYS_INLINE void fillTriangle(const Corners& corners,
                                   const Drawn& one,
                                   const PixelRays& rays,
                                   Nearest& nearest) {
  // Pixels on an edge belong to both of its triangles: rounding leaves no gap [px^2].
  constexpr float kOnEdge = -1e-9f;
  constexpr Double4 kSteps = {0.0, 1.0, 2.0, 3.0};
  constexpr Int4 kAlong = {0, 1, 2, 3};
  const double sign = corners.area() > 0.0 ? 1.0 : -1.0;
  const PixelBox& box = one.box;
  const EdgeLine first(corners.pixel(0), corners.pixel(1), sign);
  const EdgeLine second(corners.pixel(1), corners.pixel(2), sign);
  const EdgeLine third(corners.pixel(2), corners.pixel(0), sign);
  const FaceDepth face(corners, rays);
  for (int y = box.y0; y < box.y1; ++y) {
    const double first_row = first.row(y);
    const double second_row = second.row(y);
    const double third_row = third.row(y);
    for (int x = box.x0; x < box.x1; x += kAcross) {
      const Double4 at = static_cast<double>(x) + kSteps;
      const Double4 inside =
          lower(lower(first_row + first.by_x * at, second_row + second.by_x * at),
                third_row + third.by_x * at);
      // No branch asks whether any pixel is inside: it would be guessed wrong too often.
      const Int4 drawn = __builtin_convertvector(inside, Float4) >= kOnEdge && kAlong < box.x1 - x;
      nearest.draw(x, y, drawn, face.at(at, y), one.triangle);
    }
  }
}

/// Those of the triangles that are seen, backs of faces only with `backs`. Nothing branches on
/// where they lie: it would be guessed wrong too often.
RP_SIMD_CLONES void findDrawn(const Mesh& mesh,
                              const ScreenMesh& screen,
                              bool backs,
                              std::vector<Drawn>& drawn) {
  drawn.resize(mesh.triangles.size() + 1);
  const PixelBox& all = screen.box;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners corners{screen, mesh.triangles[i]};
    const glm::ivec4& a = corners.between(0);
    const glm::ivec4& b = corners.between(1);
    const glm::ivec4& c = corners.between(2);
    const PixelBox box{std::max(all.x0, std::min(std::min(a.x, b.x), c.x)),
                       std::max(all.y0, std::min(std::min(a.y, b.y), c.y)),
                       std::min(all.x1, std::max(std::max(a.z, b.z), c.z) + 1),
                       std::min(all.y1, std::max(std::max(a.w, b.w), c.w) + 1)};
    drawn[count] = {static_cast<int>(i), box};
    const double area = corners.area();
    const bool seen = (area < 0.0) | (backs & (area > 0.0));
    count += static_cast<std::size_t>(seen & (box.x0 < box.x1) & (box.y0 < box.y1));
  }
  drawn.resize(count);
}

RP_SIMD_CLONES void fillTriangles(const Mesh& mesh,
                                  const ScreenMesh& screen,
                                  const std::vector<Drawn>& drawn,
                                  const PixelRays& rays,
                                  Nearest& nearest) {
  for (const Drawn& one : drawn) {
    const Corners corners{screen, mesh.triangles[static_cast<std::size_t>(one.triangle)]};
    if (!screen.in_front && !corners.inFront()) continue;
    fillTriangle(corners, one, rays, nearest);
  }
}

/// The unit normal, turned towards the camera.
glm::vec3 normalTowards(const Camera& camera, const Corners& corners) {
  const glm::dvec3 normal = glm::normalize(corners.normal());
  const glm::dvec3 away = camera.orthographic ? glm::dvec3(0, 0, 1) : corners.point(0);
  return glm::vec3(glm::dot(normal, away) > 0.0 ? -normal : normal);
}

/// Normals only of what is seen, and once for neighbours on one face.
void shade(const Nearest& nearest,
           const Mesh& mesh,
           const ScreenMesh& screen,
           const Camera& camera,
           Image<SurfaceTexel>& surface) {
  const PixelBox& box = nearest.box();
  int last = Nearest::kNone;
  glm::vec3 normal(0.0f);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const int triangle = nearest.triangle(x, y);
      if (triangle == Nearest::kNone) continue;
      if (triangle != last) {
        last = triangle;
        normal = normalTowards(camera, {screen, mesh.triangles[static_cast<std::size_t>(last)]});
      }
      surface.at(x, y) = {normal, nearest.depth(x, y)};
    }
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
  if (screen.box.empty()) return surface;
  // A camera inside of the solid would see its backs.
  const bool backs = !mesh.solid || !screen.in_front;
  Nearest nearest(screen.box);
  std::vector<Drawn> drawn;
  findDrawn(mesh, screen, backs, drawn);
  fillTriangles(mesh, screen, drawn, PixelRays(camera, window), nearest);
  shade(nearest, mesh, screen, camera, surface);
  return surface;
}

}  // namespace host
}  // namespace rangepose
