// Vertices of smooth surface that lie too near to a ridge to stay when its edge is rounded.
#pragma once

#include <cstdint>
#include <vector>

#include "wear/edge_graph.h"

namespace rangepose {

/// Fine meshes have vertices within the width of a rounding. They move along, the less the farther
/// they are: surface up to kFollowReach radii away is pressed together.
struct Follower {
  std::uint32_t vertex = 0;
  std::uint32_t leader = 0;  ///< vertex of a ridge
  std::uint32_t corner = 0;  ///< a corner of the leader, in the fan that faces the follower
  double distance_mm = 0.0;  ///< from the ridge, in the direction in which the leader's fan moves
};

inline constexpr double kFollowReach = 3.0;

/// `inset` says for each corner how it moves for a radius of 1 mm; zero: it leads none.
std::vector<Follower> findFollowers(const EdgeGraph& graph,
                                    const std::vector<glm::dvec3>& inset,
                                    double edge_mm);

}  // namespace rangepose
