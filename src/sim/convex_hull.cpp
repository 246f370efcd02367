#include "sim/convex_hull.h"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <limits>

namespace rangepose {
namespace {

using Edge = btConvexHullComputer::Edge;

glm::dvec3 toGlm(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

std::vector<glm::dvec3> cornersOfFace(const btConvexHullComputer& computer,
                                      const std::vector<glm::dvec3>& corners,
                                      int face) {
  std::vector<glm::dvec3> polygon;
  const Edge* const first = &computer.edges[computer.faces[face]];
  const Edge* edge = first;
  do {
    polygon.push_back(corners[static_cast<std::size_t>(edge->getSourceVertex())]);
    edge = edge->getNextEdgeOfFace();
  } while (edge != first);
  return polygon;
}

/// Normal of a planar polygon, its length twice the area.
glm::dvec3 areaNormal(const std::vector<glm::dvec3>& polygon) {
  glm::dvec3 sum(0.0);
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    sum += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
  }
  return sum;
}

glm::dvec3 meanOf(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& point : points) sum += point;
  return sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

/// All but the planes.
ConvexHull surfaceOfHull(const std::vector<glm::dvec3>& points) {
  ConvexHull hull;
  if (points.empty()) return hull;
  btConvexHullComputer computer;
  computer.compute(&points[0].x, sizeof(glm::dvec3), static_cast<int>(points.size()), 0.0f, 0.0f);
  // Corners as given, not as the computer rounds them.
  for (int k = 0; k < computer.vertices.size(); ++k) {
    const int original = computer.original_vertex_index[k];
    hull.corners.push_back(original >= 0 ? points[static_cast<std::size_t>(original)]
                                         : toGlm(computer.vertices[k]));
  }
  const glm::dvec3 middle = meanOf(hull.corners);
  for (int face = 0; face < computer.faces.size(); ++face) {
    std::vector<glm::dvec3> polygon = cornersOfFace(computer, hull.corners, face);
    const double six_volumes = glm::dot(areaNormal(polygon), polygon[0] - middle);
    if (six_volumes < 0.0) std::reverse(polygon.begin(), polygon.end());
    hull.volume += std::abs(six_volumes) / 6.0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      hull.triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
    }
  }
  return hull;
}

}  // namespace

double ConvexHull::outside(const glm::dvec3& point) const {
  double farthest = std::numeric_limits<double>::lowest();
  for (const HullPlane& plane : planes) {
    farthest = std::max(farthest, glm::dot(plane.normal, point) - plane.offset);
  }
  return farthest;
}

ConvexHull convexHull(const std::vector<glm::dvec3>& points) {
  ConvexHull hull = surfaceOfHull(points);
  for (const auto& [a, b, c] : hull.triangles) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (length <= 0.0) continue;
    HullPlane plane{normal / length, std::numeric_limits<double>::lowest()};
    // The normal of a sliver may be far off: all corners have a say in where its plane lies.
    for (const glm::dvec3& corner : hull.corners) {
      plane.offset = std::max(plane.offset, glm::dot(plane.normal, corner));
    }
    hull.planes.push_back(plane);
  }
  return hull;
}

double hullVolume(const std::vector<glm::dvec3>& points) { return surfaceOfHull(points).volume; }

ConvexHull simplifiedHull(const ConvexHull& hull, int max_corners, double tolerance_mm) {
  const auto limit = static_cast<std::size_t>(std::max(4, max_corners));
  std::vector<glm::dvec3> chosen;
  for (int axis = 0; axis < 6 && !hull.corners.empty(); ++axis) {
    const double sign = axis < 3 ? 1.0 : -1.0;
    const auto less = [axis, sign](const glm::dvec3& a, const glm::dvec3& b) {
      return sign * a[axis % 3] < sign * b[axis % 3];
    };
    const glm::dvec3 corner = *std::max_element(hull.corners.begin(), hull.corners.end(), less);
    if (std::find(chosen.begin(), chosen.end(), corner) == chosen.end()) chosen.push_back(corner);
  }
  ConvexHull simple = convexHull(chosen);
  while (chosen.size() < limit) {
    double farthest = tolerance_mm;
    const glm::dvec3* next = nullptr;
    for (const glm::dvec3& corner : hull.corners) {
      // Where the chosen ones are still flat, the distance from their middle stands in.
      const double out =
          simple.planes.empty() ? glm::distance(corner, meanOf(chosen)) : simple.outside(corner);
      if (out <= farthest) continue;
      if (std::find(chosen.begin(), chosen.end(), corner) != chosen.end()) continue;
      farthest = out;
      next = &corner;
    }
    if (next == nullptr) break;
    chosen.push_back(*next);
    simple = convexHull(chosen);
  }
  return simple;
}

}  // namespace rangepose
