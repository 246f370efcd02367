// Parts made of boxes: as a mesh, and as a formula for what a parallel ray sees of them.
#pragma once

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"
#include "stages/reference.h"

namespace rangepose::test {

struct Box {
  glm::dvec3 low{0.0};   ///< [mm]
  glm::dvec3 high{0.0};  ///< [mm]
};

/// An L-shaped bracket that looks different from every side.
inline std::vector<Box> bracketBoxes() {
  return {{{0.0, 0.0, 0.0}, {40.0, 12.0, 10.0}}, {{0.0, 0.0, 10.0}, {9.0, 12.0, 34.0}}};
}

inline void addBox(Mesh& mesh, const Box& box) {
  const unsigned first = static_cast<unsigned>(mesh.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back((corner & 1U) != 0 ? box.high.x : box.low.x,
                               (corner & 2U) != 0 ? box.high.y : box.low.y,
                               (corner & 4U) != 0 ? box.high.z : box.low.z);
  }
  constexpr unsigned kFaces[6][4] = {
      {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    mesh.triangles.emplace_back(first + face[0], first + face[1], first + face[2]);
    mesh.triangles.emplace_back(first + face[0], first + face[2], first + face[3]);
  }
}

inline Mesh meshOf(const std::vector<Box>& boxes) {
  Mesh mesh;
  mesh.name = "boxes";
  for (const Box& box : boxes) addBox(mesh, box);
  return mesh;
}

/// What a ray hits first.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();  ///< along the ray [mm]
  double cosine = 0.0;                                        ///< |cos(ray, normal)|
  int face = -1;                                              ///< 3 * box + axis of the normal
  bool operator<(const Hit& other) const { return distance < other.distance; }
};

/// The slab test: enters at the last entry into the three pairs of planes.
inline Hit hitBox(const Box& box, const glm::dvec3& origin, const glm::dvec3& direction) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0.0) {
      if (origin[i] < box.low[i] || origin[i] > box.high[i]) return {};
      continue;
    }
    const double a = (box.low[i] - origin[i]) / direction[i];
    const double b = (box.high[i] - origin[i]) / direction[i];
    if (std::min(a, b) > enter) {
      enter = std::min(a, b);
      axis = i;
    }
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave) return {};
  return {enter, std::abs(direction[axis]), axis};
}

inline Hit hitBoxes(const std::vector<Box>& boxes,
                    const glm::dvec3& origin,
                    const glm::dvec3& direction) {
  Hit nearest;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Hit hit = hitBox(boxes[i], origin, direction);
    hit.face += 3 * static_cast<int>(i);
    nearest = std::min(nearest, hit);
  }
  return nearest;
}

/// An object with random views, not rendered yet.
inline ReferenceObject objectOf(const std::vector<Box>& boxes, int views, int size, unsigned seed) {
  ReferenceObject object;
  object.mesh = meshOf(boxes);
  const Sphere sphere = boundingSphere(object.mesh);
  object.center_mm = sphere.center_mm;
  object.radius_mm = sphere.radius_mm;
  object.diameter_mm = diameter(object.mesh);
  object.size = size;
  object.pixel_mm = 2.0 * sphere.radius_mm / (size - 4);
  std::mt19937 random(seed);
  const auto uniform = [&random] {
    return static_cast<double>(random()) / 4294967296.0 * 2.0 - 1.0;
  };
  for (int i = 0; i < views; ++i) {
    ReferenceView view;
    view.rotation = rotationFromVector(3.0 * glm::dvec3(uniform(), uniform(), uniform()));
    object.views.push_back(view);
  }
  return object;
}

}  // namespace rangepose::test
