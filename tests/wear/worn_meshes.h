// Meshes with holes, and measures of what wear did to them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/mesh.h"
#include "geometry/triangle_corners.h"

namespace rangepose {

/// Between two outlines of `sides` points each about the z axis, from z = 0 to `height_mm`. The
/// radii are functions of the angle.
template <typename Outer, typename Inner>
Mesh ringMesh(unsigned sides, double height_mm, const Outer& outer_mm, const Inner& inner_mm) {
  Mesh mesh;
  mesh.name = "ring";
  for (unsigned i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const glm::dvec3 outward(std::cos(angle), std::sin(angle), 0.0);
    const glm::dvec3 up(0.0, 0.0, height_mm);
    mesh.vertices.emplace_back(outer_mm(angle) * outward);
    mesh.vertices.emplace_back(outer_mm(angle) * outward + up);
    mesh.vertices.emplace_back(inner_mm(angle) * outward + up);
    mesh.vertices.emplace_back(inner_mm(angle) * outward);
  }
  for (unsigned i = 0; i < sides; ++i) {
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned a = 4 * i + k;
      const unsigned b = 4 * i + (k + 1) % 4;
      const unsigned c = 4 * ((i + 1) % sides) + k;
      const unsigned d = 4 * ((i + 1) % sides) + (k + 1) % 4;
      mesh.triangles.emplace_back(a, c, d);
      mesh.triangles.emplace_back(a, d, b);
    }
  }
  return mesh;
}

inline Mesh tubeMesh(double outer_mm, double inner_mm, double height_mm) {
  return ringMesh(
      48, height_mm, [=](double) { return outer_mm; }, [=](double) { return inner_mm; });
}

/// A square plate with a round hole in its middle.
inline Mesh plateWithHole(double half_side_mm, double hole_radius_mm, double height_mm) {
  const auto square = [=](double angle) {
    return half_side_mm / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
  };
  return ringMesh(48, height_mm, square, [=](double) { return hole_radius_mm; });
}

/// A full cylinder: the tube without its bore.
inline Mesh rodMesh(double radius_mm, double height_mm) {
  Mesh mesh = tubeMesh(radius_mm, 0.5 * radius_mm, height_mm);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (i % 4 >= 2) mesh.vertices[i].x = mesh.vertices[i].y = 0.0f;
  }
  return cleaned(mesh);
}

/// The same surface, each triangle cut into four.
inline Mesh quartered(const Mesh& mesh) {
  Mesh result;
  result.name = mesh.name;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const auto first = static_cast<unsigned>(result.vertices.size());
    for (int k = 0; k < 3; ++k) result.vertices.push_back(mesh.vertices[triangle[k]]);
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& a = mesh.vertices[triangle[k]];
      const glm::vec3& b = mesh.vertices[triangle[(k + 1) % 3]];
      result.vertices.push_back(0.5f * (a + b));
    }
    result.triangles.emplace_back(first, first + 3, first + 5);
    result.triangles.emplace_back(first + 3, first + 1, first + 4);
    result.triangles.emplace_back(first + 5, first + 4, first + 2);
    result.triangles.emplace_back(first + 3, first + 4, first + 5);
  }
  return result;
}

inline double volumeOf(const Mesh& mesh) {
  double volume = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners corners(mesh, triangle);
    volume += glm::dot(corners.a, corners.cross()) / 6.0;
  }
  return volume;
}

inline double areaOf(const Mesh& mesh) {
  return mesh.triangles.empty() ? 0.0 : cumulativeAreas(mesh).back();
}

/// Whether each edge belongs to exactly two triangles, once in each direction; vertices count as
/// they are numbered.
inline bool isManifold(const Mesh& mesh) {
  std::map<std::pair<unsigned, unsigned>, int> uses;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{triangle[k], triangle[(k + 1) % 3]}];
  }
  return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    const auto back = uses.find({use.first.second, use.first.first});
    return use.second == 1 && back != uses.end() && back->second == 1;
  });
}

/// How often a line through `point` along the z axis meets faces that look up, and such that look
/// down.
inline std::array<int, 2> facesAbove(const Mesh& mesh, const glm::dvec2& point) {
  std::array<int, 2> count{};
  for (const glm::uvec3& triangle : mesh.triangles) {
    std::array<double, 3> area{};
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 a = glm::dvec2(mesh.vertices[triangle[k]]) - point;
      const glm::dvec2 b = glm::dvec2(mesh.vertices[triangle[(k + 1) % 3]]) - point;
      area[static_cast<std::size_t>(k)] = a.x * b.y - a.y * b.x;
    }
    if (area[0] > 0.0 && area[1] > 0.0 && area[2] > 0.0) ++count[0];
    if (area[0] < 0.0 && area[1] < 0.0 && area[2] < 0.0) ++count[1];
  }
  return count;
}

}  // namespace rangepose
