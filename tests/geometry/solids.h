// Closed parts whose symmetries follow from how they are made.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose::test {

/// A prism over a polygon that is star-shaped about the origin, from z = low to high.
inline void addPrism(Mesh& mesh, const std::vector<glm::dvec2>& outline, double low, double high) {
  const unsigned first = static_cast<unsigned>(mesh.vertices.size());
  const unsigned count = static_cast<unsigned>(outline.size());
  for (const glm::dvec2& corner : outline) {
    mesh.vertices.emplace_back(corner.x, corner.y, low);
    mesh.vertices.emplace_back(corner.x, corner.y, high);
  }
  mesh.vertices.emplace_back(0.0, 0.0, low);
  mesh.vertices.emplace_back(0.0, 0.0, high);
  const unsigned centre = first + 2 * count;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned a = first + 2 * i;
    const unsigned b = first + 2 * ((i + 1) % count);
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
    mesh.triangles.emplace_back(centre, b, a);
    mesh.triangles.emplace_back(centre + 1, a + 1, b + 1);
  }
}

/// Corners at the given radius; `turn` shifts them [rad].
inline std::vector<glm::dvec2> regularPolygon(int sides, double radius, double turn = 0.0) {
  std::vector<glm::dvec2> outline;
  for (int i = 0; i < sides; ++i) {
    const double angle = turn + 2.0 * std::numbers::pi * i / sides;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return outline;
}

inline Mesh prism(int sides, double radius, double height) {
  Mesh mesh;
  mesh.name = "prism";
  addPrism(mesh, regularPolygon(sides, radius), 0.0, height);
  return mesh;
}

/// A cylinder whose sides are unequal: corners where a walk with uneven steps comes by.
inline Mesh unevenCylinder(double radius, double height) {
  std::vector<glm::dvec2> outline;
  double angle = 0.0;
  while (angle < 2.0 * std::numbers::pi - 0.02) {
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    angle += 0.08 + 0.06 * std::sin(3.0 * angle) * std::sin(3.0 * angle);
  }
  Mesh mesh;
  mesh.name = "cylinder";
  addPrism(mesh, outline, 0.0, height);
  return mesh;
}

/// Hexagon head on a round shank. `notch_mm` is how deep a groove is cut into one side of the head.
inline Mesh boltMesh(double notch_mm) {
  Mesh mesh;
  mesh.name = "bolt";
  addPrism(mesh, regularPolygon(48, 8.0), 0.0, 40.0);
  std::vector<glm::dvec2> head;
  const std::vector<glm::dvec2> hexagon = regularPolygon(6, 14.0);
  for (std::size_t i = 0; i < 6; ++i) {
    head.push_back(hexagon[i]);
    if (i != 0 || notch_mm == 0.0) continue;
    const glm::dvec2 middle = 0.5 * (hexagon[0] + hexagon[1]);
    const glm::dvec2 along = glm::normalize(hexagon[1] - hexagon[0]);
    const glm::dvec2 inwards = -glm::normalize(middle);
    head.push_back(middle - 1.5 * along);
    head.push_back(middle - 1.5 * along + notch_mm * inwards);
    head.push_back(middle + 1.5 * along + notch_mm * inwards);
    head.push_back(middle + 1.5 * along);
  }
  addPrism(mesh, head, 40.0, 50.0);
  return mesh;
}

/// The hull of the corners of a regular solid is not needed: its faces are given.
inline Mesh solidOf(const std::vector<glm::vec3>& corners, const std::vector<glm::uvec3>& faces) {
  Mesh mesh;
  mesh.name = "solid";
  mesh.vertices = corners;
  mesh.triangles = faces;
  return mesh;
}

inline Mesh tetrahedron() {
  return solidOf({{9, 9, 9}, {9, -9, -9}, {-9, 9, -9}, {-9, -9, 9}},
                 {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

/// Corners at permutations of (0, 1, golden ratio); faces are the triples of nearest neighbours.
inline Mesh icosahedron() {
  std::vector<glm::vec3> corners;
  const double phi = std::numbers::phi;
  for (const double s : {-10.0, 10.0}) {
    for (const double t : {-10.0 * phi, 10.0 * phi}) {
      corners.emplace_back(0.0, s, t);
      corners.emplace_back(s, t, 0.0);
      corners.emplace_back(t, 0.0, s);
    }
  }
  std::vector<glm::uvec3> faces;
  const auto near = [&](unsigned a, unsigned b) {
    return glm::distance(corners[a], corners[b]) < 20.1f;
  };
  for (unsigned a = 0; a < 12; ++a) {
    for (unsigned b = a + 1; b < 12; ++b) {
      for (unsigned c = b + 1; c < 12; ++c) {
        if (near(a, b) && near(b, c) && near(a, c)) faces.emplace_back(a, b, c);
      }
    }
  }
  return solidOf(corners, faces);
}

inline Mesh moved(Mesh mesh, const Pose& pose) {
  for (glm::vec3& vertex : mesh.vertices) vertex = glm::vec3(pose * glm::dvec3(vertex));
  return mesh;
}

}  // namespace rangepose::test
