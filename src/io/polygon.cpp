#include "io/polygon.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace rangepose {
namespace {

using Vertices = std::vector<glm::dvec3>;

/// Newell's normal: twice the area of the polygon along its mean normal.
glm::dvec3 polygonNormal(const Vertices& vertices, const std::vector<unsigned>& corners) {
  glm::dvec3 normal{0.0};
  const glm::dvec3 origin = vertices[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += glm::cross(vertices[corners[i]] - origin, vertices[corners[i + 1]] - origin);
  }
  return normal;
}

double turn(const glm::dvec3& a,
            const glm::dvec3& b,
            const glm::dvec3& c,
            const glm::dvec3& normal) {
  return glm::dot(glm::cross(b - a, c - b), normal);
}

/// True when corner i sticks out and no other corner lies in the triangle that it would cut off.
bool isEar(const Vertices& vertices,
           const std::vector<unsigned>& corners,
           std::size_t i,
           const glm::dvec3& normal) {
  const std::size_t count = corners.size();
  const unsigned before = corners[(i + count - 1) % count];
  const unsigned after = corners[(i + 1) % count];
  const glm::dvec3& a = vertices[before];
  const glm::dvec3& b = vertices[corners[i]];
  const glm::dvec3& c = vertices[after];
  if (!(turn(a, b, c, normal) > 0.0)) return false;
  for (const unsigned other : corners) {
    if (other == before || other == corners[i] || other == after) continue;
    const glm::dvec3& p = vertices[other];
    if (turn(a, b, p, normal) >= 0.0 && turn(b, c, p, normal) >= 0.0 &&
        turn(c, a, p, normal) >= 0.0) {
      return false;
    }
  }
  return true;
}

}  // namespace

unsigned checkedCorner(double index,
                       std::size_t vertex_count,
                       std::int64_t face,
                       const std::string& where) {
  if (index >= 0.0 && index < static_cast<double>(vertex_count) && index == std::floor(index)) {
    return static_cast<unsigned>(index);
  }
  throw Error(fmt::format("{}: face {} names vertex {}, but there are {}; repair the file",
                          where,
                          face,
                          index,
                          vertex_count));
}

void checkCornerCount(std::int64_t corners, std::int64_t face, const std::string& where) {
  if (corners <= kMaxPolygonCorners) return;
  throw Error(
      fmt::format("{}: face {} has {} corners; cut it into triangles", where, face, corners));
}

void appendTriangles(const Vertices& vertices,
                     std::vector<unsigned> corners,
                     std::vector<glm::uvec3>& triangles) {
  if (corners.size() < 3) return;
  if (corners.size() == 3) {
    triangles.emplace_back(corners[0], corners[1], corners[2]);
    return;
  }
  const glm::dvec3 normal = polygonNormal(vertices, corners);
  while (corners.size() > 3) {
    // The second corner first: a convex polygon becomes a fan around its first corner.
    std::size_t ear = 1;
    for (std::size_t step = 0; step < corners.size(); ++step) {
      const std::size_t candidate = (1 + step) % corners.size();
      if (isEar(vertices, corners, candidate, normal)) {
        ear = candidate;
        break;
      }
    }
    const std::size_t count = corners.size();
    triangles.emplace_back(
        corners[(ear + count - 1) % count], corners[ear], corners[(ear + 1) % count]);
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.emplace_back(corners[0], corners[1], corners[2]);
}

}  // namespace rangepose
