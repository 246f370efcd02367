// Closed meshes made of boxes, and an independent test for what lies inside of one.
#pragma once

#include "geometry/mesh.h"
#include "support/box_mesh.h"

namespace rangepose {

/// Axis-parallel box, faces outwards.
inline Mesh boxMesh(const glm::dvec3& low, const glm::dvec3& high) {
  return test::meshOf({{low, high}});
}

/// The outline of an L in x and y.
inline Mesh angleMesh() {
  return test::meshOf({{{0, 0, 0}, {60, 15, 20}}, {{0, 15, 0}, {15, 50, 20}}});
}

/// Whether a point of the mesh's frame lies inside: odd number of faces along a ray that meets no
/// edge of these meshes by its odd direction.
inline bool isInside(const Mesh& mesh, const glm::dvec3& point) {
  const glm::dvec3 direction(0.5713, 0.3307, 0.7511);
  int hits = 0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[triangle.x];
    const glm::dvec3 ab = glm::dvec3(mesh.vertices[triangle.y]) - a;
    const glm::dvec3 ac = glm::dvec3(mesh.vertices[triangle.z]) - a;
    const glm::dvec3 p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0.0) continue;
    const glm::dvec3 from_a = point - a;
    const double u = glm::dot(from_a, p) / determinant;
    const glm::dvec3 q = glm::cross(from_a, ab);
    const double v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(ac, q) / determinant;
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0) ++hits;
  }
  return hits % 2 == 1;
}

}  // namespace rangepose
