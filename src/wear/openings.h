// Rims of a part's holes and openings, which dirt, chips or paint may close.
#pragma once

#include <cstdint>
#include <vector>

#include "wear/edge_graph.h"

namespace rangepose {

/// A closed loop of ridges, nearly in one plane, with free space inside of it: the end of a pipe or
/// of a bore. Seen from its middle each edge of the loop runs the same way around.
struct Rim {
  std::vector<std::uint32_t> loop;  ///< vertices of the graph, in their order along it
  glm::dvec3 middle_mm{0.0};        ///< of the area within
  glm::dvec3 axis{0.0};             ///< unit normal of the plane, of either sign
  double width_mm = 0.0;            ///< of a disc with the same area
  int other = -1;  ///< index of the rim at the other end of the same bore; -1: none
};

/// All rims with a width in [smallest_mm, largest_mm]. A pipe's end has one where its bore starts;
/// the rim around the pipe's outside is none, as there is material next to it on the inside.
std::vector<Rim> findRims(const EdgeGraph& graph, double smallest_mm, double largest_mm);

}  // namespace rangepose
