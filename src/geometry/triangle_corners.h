// Corners of a mesh's triangles, and how its area adds up.
#pragma once

#include <vector>

#include "core/glm.h"
#include "geometry/mesh.h"

namespace rangepose {

struct TriangleCorners {
  glm::dvec3 a, b, c;

  TriangleCorners(const Mesh& mesh, const glm::uvec3& triangle)
      : a(mesh.vertices[triangle.x]), b(mesh.vertices[triangle.y]), c(mesh.vertices[triangle.z]) {}
  /// Along the normal, as long as twice the area.
  glm::dvec3 cross() const { return glm::cross(b - a, c - a); }
  double area() const { return 0.5 * glm::length(cross()); }
};

/// Area of all triangles up to each, itself included [mm^2].
std::vector<double> cumulativeAreas(const Mesh& mesh);

}  // namespace rangepose
