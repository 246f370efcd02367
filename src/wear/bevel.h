// Rounds the sharp edges of a part.
#pragma once

#include <cstdint>
#include <vector>

#include "wear/edge_graph.h"

namespace rangepose {

struct BevelledMesh {
  std::vector<glm::dvec3> vertices;  ///< [mm]
  /// First those of the graph, in its order, smaller; then those along edges and at corners.
  std::vector<glm::uvec3> triangles;
  /// For each vertex of the graph the one that took its place: the middle of the rounding.
  std::vector<std::uint32_t> middle;
};

/// Draws the smooth surfaces back from the ridges, by `edge_mm` where there is room, and closes the
/// gaps by two strips along each ridge, by one if two made the mesh too large, and by a polygon at
/// each corner. Sharp edges that are no ridges stay as they are, and so do edges that more or less
/// than two triangles share. A closed mesh stays closed.
BevelledMesh bevelled(const EdgeGraph& graph, double edge_mm);

}  // namespace rangepose
