// The edges of a mesh: which triangles meet there, and whether the surface bends sharply.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "core/glm.h"
#include "geometry/mesh.h"

namespace rangepose {

/// Edges along which the surface bends by more than 30 degrees are sharp: the cosine.
inline constexpr double kSharpCos = 0.8660254037844386;

/// Corner k of triangle t has the number 3 t + k.
inline std::uint32_t nextCorner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// An edge that exactly two triangles share, each in its own direction.
struct GraphEdge {
  std::uint32_t from = 0;   ///< vertex
  std::uint32_t to = 0;     ///< vertex
  std::uint32_t left = 0;   ///< corner at `from` of the triangle that runs from `from` to `to`
  std::uint32_t right = 0;  ///< corner at `to` of the triangle that runs from `to` to `from`
  bool sharp = false;
  bool ridge = false;  ///< sharp, and the material lies within the bend (convex)
};

struct EdgeGraph {
  std::vector<glm::dvec3> vertices;   ///< [mm], no two at the same place
  std::vector<glm::uvec3> triangles;  ///< of three different vertices
  std::vector<glm::dvec3> normals;    ///< unit; needles too thin to have one take a neighbour's
  std::vector<char> needle;           ///< of each triangle: whether it is that thin
  std::vector<GraphEdge> edges;       ///< sorted by their vertices
  std::vector<char> awkward;          ///< of each vertex: whether an edge of it is no GraphEdge

  std::uint32_t vertexOf(std::uint32_t corner) const {
    return triangles[corner / 3][static_cast<int>(corner % 3)];
  }
  glm::dvec3 cross(std::size_t triangle) const;  ///< along the normal, twice the area [mm^2]
};

/// Flat faces are filled with other triangles than the mesh has (flat_flips.h).
EdgeGraph edgeGraph(const Mesh& mesh);

/// Sets of numbers that are joined pair by pair; each set is named after its smallest number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t rootOf(std::uint32_t item) {
    while (parent_[item] != item) {
      parent_[item] = parent_[parent_[item]];
      item = parent_[item];
    }
    return item;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = rootOf(a);
    const std::uint32_t root_b = rootOf(b);
    if (root_a < root_b) parent_[root_b] = root_a;
    if (root_b < root_a) parent_[root_a] = root_b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace rangepose
