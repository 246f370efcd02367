// The smallest sphere around the vertices of a mesh: unlike the sphere about the middle of a box it
// has every symmetry of the part.
#include <array>
#include <cmath>
#include <vector>

#include "geometry/mesh.h"

namespace rangepose {
namespace {

/// Points are inside up to this share of the radius.
constexpr double kInside = 1e-10;

/// Points on the sphere that hold it: no smaller one is around them. At most four.
struct Support {
  std::array<glm::dvec3, 4> points{};
  std::size_t count = 0;
  void add(const glm::dvec3& point) { points[count++] = point; }
};

bool holds(const Sphere& sphere, const glm::dvec3& point) {
  return glm::distance(point, sphere.center_mm) <= sphere.radius_mm * (1.0 + kInside);
}

/// The smallest sphere with all of the points on it, its centre in the space that they span; false
/// where they span less than they should: fewer of them give the same sphere.
bool sphereThrough(const Support& support, Sphere& sphere) {
  constexpr double kFlat = 1e-10;
  const glm::dvec3& first = support.points[0];
  // Orthonormal directions; the centre's share along each follows from one more point.
  std::array<glm::dvec3, 3> axes{};
  glm::dvec3 offset(0.0);
  for (std::size_t i = 1; i < support.count; ++i) {
    const glm::dvec3 to = support.points[i] - first;
    glm::dvec3 beside = to;
    for (std::size_t k = 0; k + 1 < i; ++k) beside -= glm::dot(beside, axes[k]) * axes[k];
    const double length = glm::length(beside);
    if (!(length > kFlat * glm::length(to))) return false;
    axes[i - 1] = beside / length;
    offset += (0.5 * glm::dot(to, to) - glm::dot(offset, to)) / length * axes[i - 1];
  }
  sphere = {first + offset, glm::length(offset)};
  return true;
}

bool holdsAll(const Sphere& sphere, const Support& support) {
  for (std::size_t i = 0; i < support.count; ++i) {
    if (!holds(sphere, support.points[i])) return false;
  }
  return true;
}

/// The smallest sphere around `support` and a point outside of its sphere, which then lies on it:
/// that of the subset whose sphere holds the others. False where rounding hides it.
bool smallestWith(const glm::dvec3& point, Support& support, Sphere& sphere) {
  Support best;
  Sphere smallest;
  for (unsigned subset = 1; subset < 1U << support.count; ++subset) {
    Support chosen;
    chosen.add(point);
    for (std::size_t i = 0; i < support.count; ++i) {
      if ((subset >> i & 1U) != 0 && chosen.count < 4) chosen.add(support.points[i]);
    }
    Sphere through;
    if (!sphereThrough(chosen, through) || !holdsAll(through, support)) continue;
    if (best.count > 0 && through.radius_mm >= smallest.radius_mm) continue;
    best = chosen;
    smallest = through;
  }
  if (best.count == 0) return false;
  support = best;
  sphere = smallest;
  return true;
}

const glm::vec3& farthestFrom(const glm::dvec3& center, const std::vector<glm::vec3>& vertices) {
  std::size_t farthest = 0;
  double most = -1.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 off = glm::dvec3(vertices[i]) - center;
    const double squared = glm::dot(off, off);
    if (squared <= most) continue;
    most = squared;
    farthest = i;
  }
  return vertices[farthest];
}

}  // namespace

Sphere boundingSphere(const Mesh& mesh) {
  if (mesh.vertices.empty()) return {};
  // Of the spheres around a few vertices the next one takes in the vertex that is farthest outside
  // (Gaertner, "Fast and robust smallest enclosing balls", 1999). Each is larger than the last one,
  // so it ends; some ten steps do even for large meshes.
  constexpr int kMostSteps = 1000;
  Support support;
  support.add(mesh.vertices[0]);
  Sphere sphere{support.points[0], 0.0};
  for (int step = 0; step < kMostSteps; ++step) {
    const glm::dvec3 point = farthestFrom(sphere.center_mm, mesh.vertices);
    if (holds(sphere, point)) break;
    const double before = sphere.radius_mm;
    Sphere larger;
    Support of_larger = support;
    if (!smallestWith(point, of_larger, larger) || !(larger.radius_mm > before)) break;
    support = of_larger;
    sphere = larger;
  }
  const glm::dvec3 farthest = farthestFrom(sphere.center_mm, mesh.vertices);
  sphere.radius_mm = glm::distance(farthest, sphere.center_mm);
  return sphere;
}

}  // namespace rangepose
