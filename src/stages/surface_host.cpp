#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

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

struct ScreenVertex {
  glm::dvec3 point_mm;  ///< in the camera frame
  glm::dvec2 pixel;     ///< in the window
  glm::ivec2 first;     ///< pixel centres from here on are not left of or above it
  glm::ivec2 last;      ///< pixel centres up to here are not right of or below it
  bool in_front;
};

/// Rounded down; far outside of any image it stays there.
int floorOf(double value) {
  constexpr double kFar = 1.0e9;
  const double bounded = std::clamp(value, -kFar, kFar);
  const int truncated = static_cast<int>(bounded);
  return truncated - (static_cast<double>(truncated) > bounded ? 1 : 0);
}

/// The plane of a triangle seen along the ray of a pixel.
class DepthPlane {
 public:
  DepthPlane(const Camera& camera, const glm::dvec3& normal, const glm::dvec3& point)
      : camera_(camera), normal_(normal), offset_(glm::dot(normal, point)) {}

  /// Depth along z at camera pixel (u, v).
  double depth(double u, double v) const {
    if (camera_.orthographic) {
      const glm::dvec3 p = camera_.unproject(u, v, 0.0);
      return (offset_ - normal_.x * p.x - normal_.y * p.y) / normal_.z;
    }
    return offset_ / glm::dot(normal_, camera_.unproject(u, v, 1.0));
  }

 private:
  const Camera& camera_;
  glm::dvec3 normal_;
  double offset_;
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
  double at(double x, double y) const { return by_x * x + by_y * y + at_origin; }
};

/// The face that a triangle lies in, for its pixels. Made when the first of them is found: most
/// triangles of a fine mesh have none.
class Face {
 public:
  Face(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Camera& camera)
      : normal_(unitNormal(a, b, c, camera)),
        plane_(camera, normal_, a.point_mm),
        low_z_(std::min({a.point_mm.z, b.point_mm.z, c.point_mm.z})),
        high_z_(std::max({a.point_mm.z, b.point_mm.z, c.point_mm.z})) {}

  /// A face seen edge on has no stable plane: its corners bound the depth.
  float depth(double u, double v) const {
    const double z = plane_.depth(u, v);
    return static_cast<float>(std::isfinite(z) ? std::clamp(z, low_z_, high_z_) : low_z_);
  }
  SurfaceTexel texel(float depth) const { return {glm::vec3(normal_), depth}; }

 private:
  static glm::dvec3 unitNormal(const ScreenVertex& a,
                               const ScreenVertex& b,
                               const ScreenVertex& c,
                               const Camera& camera) {
    glm::dvec3 normal = glm::cross(b.point_mm - a.point_mm, c.point_mm - a.point_mm);
    normal /= glm::length(normal);
    const bool away =
        glm::dot(normal, camera.orthographic ? glm::dvec3(0, 0, 1) : a.point_mm) > 0.0;
    return away ? -normal : normal;
  }

  glm::dvec3 normal_;
  DepthPlane plane_;
  double low_z_;
  double high_z_;
};

void fillTriangle(const ScreenVertex& a,
                  const ScreenVertex& b,
                  const ScreenVertex& c,
                  const Camera& camera,
                  const SurfaceWindow& window,
                  Image<SurfaceTexel>& surface) {
  // Pixels on an edge belong to both of its triangles: rounding leaves no gap [px^2].
  constexpr double kOnEdge = -1e-9;
  // Most triangles of a fine mesh lie between pixel centres.
  const int x0 = std::max(0, std::min({a.first.x, b.first.x, c.first.x}));
  const int x1 = std::min(window.width - 1, std::max({a.last.x, b.last.x, c.last.x}));
  if (x0 > x1) return;
  const int y0 = std::max(0, std::min({a.first.y, b.first.y, c.first.y}));
  const int y1 = std::min(window.height - 1, std::max({a.last.y, b.last.y, c.last.y}));
  if (y0 > y1) return;
  const glm::dvec2 ab = b.pixel - a.pixel;
  const glm::dvec2 ac = c.pixel - a.pixel;
  const double area = ab.x * ac.y - ab.y * ac.x;
  if (area == 0.0) return;
  const double sign = area > 0.0 ? 1.0 : -1.0;
  const EdgeLine first(a.pixel, b.pixel, sign);
  const EdgeLine second(b.pixel, c.pixel, sign);
  const EdgeLine third(c.pixel, a.pixel, sign);
  std::optional<Face> face;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double inside = std::min({first.at(x, y), second.at(x, y), third.at(x, y)});
      if (inside < kOnEdge) continue;
      if (!face) face.emplace(a, b, c, camera);
      const float depth = face->depth(window.x0 + x * window.step, window.y0 + y * window.step);
      SurfaceTexel& texel = surface.at(x, y);
      if (texel.w == 0.0f || depth < texel.w) texel = face->texel(depth);
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
  std::vector<ScreenVertex> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    ScreenVertex& vertex = vertices[i];
    vertex.point_mm = camera_from_object * glm::dvec3(mesh.vertices[i]);
    vertex.in_front = camera.orthographic || vertex.point_mm.z > 1.0;
    if (!vertex.in_front) continue;
    const glm::dvec2 pixel = camera.project(vertex.point_mm);
    vertex.pixel = (pixel - glm::dvec2(window.x0, window.y0)) / static_cast<double>(window.step);
    vertex.last = {floorOf(vertex.pixel.x), floorOf(vertex.pixel.y)};
    vertex.first = {-floorOf(-vertex.pixel.x), -floorOf(-vertex.pixel.y)};
  }
  for (const glm::uvec3& triangle : mesh.triangles) {
    const ScreenVertex& a = vertices[triangle.x];
    const ScreenVertex& b = vertices[triangle.y];
    const ScreenVertex& c = vertices[triangle.z];
    if (!a.in_front || !b.in_front || !c.in_front) continue;
    fillTriangle(a, b, c, camera, window, surface);
  }
  return surface;
}

}  // namespace host
}  // namespace rangepose
