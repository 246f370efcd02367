// Where the surface around each vertex goes when sharp edges are rounded.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "wear/edge_graph.h"

namespace rangepose {

/// The triangles around a vertex form umbrellas (one, where the mesh is clean). Ridges cut an
/// umbrella into fans; each fan moves away from its ridges, in its own surface.
struct BevelFans {
  std::vector<std::uint32_t> fan;       ///< of each corner: the fan it belongs to
  std::vector<std::uint32_t> umbrella;  ///< of each corner
  std::vector<glm::dvec3> inset;        ///< of each fan: how it moves, for a radius of 1 mm
  std::vector<int> ridges;              ///< of each umbrella: how many ridges end there
  std::vector<double> radius_mm;        ///< of each vertex; 0: it stays

  /// Where a corner goes [mm].
  glm::dvec3 moved(const EdgeGraph& graph, std::uint32_t corner) const {
    const std::uint32_t vertex = graph.vertexOf(corner);
    return graph.vertices[vertex] + radius_mm[vertex] * inset[fan[corner]];
  }
};

/// What is smaller doesn't count when edges are rounded by that radius [mm]: no depth camera tells
/// it from nothing.
inline double unseenBy(double edge_mm) { return std::min(0.02, 0.1 * edge_mm); }

/// Radii of `edge_mm`, or less where the surface is narrow: no triangle loses more than 60 % of its
/// area or turns over, no edge more than 60 % of its length. No corner moves by more than 1.5
/// radii.
BevelFans bevelFans(const EdgeGraph& graph, double edge_mm);

}  // namespace rangepose
