// Closed meshes made of boxes, and an independent test for what lies inside of one.
#pragma once

#include <string>

#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

/// Axis-parallel box, faces outwards.
inline Mesh boxMesh(const glm::vec3& low, const glm::vec3& high) {
  Mesh mesh;
  mesh.name = "box";
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.push_back({(k & 1) != 0 ? high.x : low.x,
                             (k & 2) != 0 ? high.y : low.y,
                             (k & 4) != 0 ? high.z : low.z});
  }
  mesh.triangles = {{0, 2, 1},
                    {1, 2, 3},
                    {4, 5, 6},
                    {5, 7, 6},
                    {0, 1, 4},
                    {1, 5, 4},
                    {2, 6, 3},
                    {3, 6, 7},
                    {0, 4, 2},
                    {2, 4, 6},
                    {1, 3, 5},
                    {3, 7, 5}};
  return mesh;
}

/// Two boxes that share a face's plane: the outline of an L in x and y, 24 triangles.
inline Mesh angleMesh() {
  Mesh mesh = boxMesh({0, 0, 0}, {60, 15, 20});
  const Mesh arm = boxMesh({0, 15, 0}, {15, 50, 20});
  const auto first = static_cast<unsigned>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), arm.vertices.begin(), arm.vertices.end());
  for (const glm::uvec3& triangle : arm.triangles)
    mesh.triangles.push_back(triangle + glm::uvec3(first));
  mesh.name = "angle";
  return mesh;
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
