#include "sim/bevel_followers.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace rangepose {
namespace {

/// A vertex that may follow a leader; the nearest leader gets it.
struct Offer {
  double distance_mm;  ///< between the vertices
  std::uint32_t vertex;
  std::uint32_t corner;  ///< of the leader
  bool operator<(const Offer& other) const {
    return std::tie(distance_mm, vertex, corner) >
           std::tie(other.distance_mm, other.vertex, other.corner);
  }
};

/// Of each vertex: whether the surface around it is smooth and whole.
std::vector<char> smoothVertices(const EdgeGraph& graph) {
  std::vector<char> smooth(graph.vertices.size(), 1);
  for (std::size_t v = 0; v < smooth.size(); ++v) smooth[v] = graph.awkward[v] != 0 ? 0 : 1;
  for (const GraphEdge& edge : graph.edges) {
    if (edge.sharp) smooth[edge.from] = smooth[edge.to] = 0;
  }
  return smooth;
}

/// The corners of each vertex: `list` from `first[v]` up to `first[v + 1]`.
struct CornersOfVertices {
  explicit CornersOfVertices(const EdgeGraph& graph)
      : first(graph.vertices.size() + 1, 0), list(3 * graph.triangles.size()) {
    for (std::uint32_t corner = 0; corner < list.size(); ++corner)
      ++first[graph.vertexOf(corner) + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t corner = 0; corner < list.size(); ++corner)
      list[next[graph.vertexOf(corner)]++] = corner;
  }
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> list;
};

}  // namespace

std::vector<Follower> findFollowers(const EdgeGraph& graph,
                                    const std::vector<glm::dvec3>& inset,
                                    double edge_mm) {
  const double reach_mm = kFollowReach * edge_mm;
  std::vector<char> free = smoothVertices(graph);
  std::priority_queue<Offer> offers;
  const auto offer = [&](std::uint32_t corner, std::uint32_t leader) {
    for (const std::uint32_t next : {nextCorner(corner), nextCorner(nextCorner(corner))}) {
      const std::uint32_t vertex = graph.vertexOf(next);
      const double distance =
          glm::distance(graph.vertices[vertex], graph.vertices[graph.vertexOf(leader)]);
      // Along a ridge vertices may be far apart.
      if (free[vertex] != 0 && distance <= 2.0 * reach_mm) offers.push({distance, vertex, leader});
    }
  };
  for (std::uint32_t corner = 0; corner < inset.size(); ++corner) {
    if (inset[corner] != glm::dvec3(0.0)) offer(corner, corner);
  }
  const CornersOfVertices corners(graph);
  std::vector<Follower> followers;
  while (!offers.empty()) {
    const Offer best = offers.top();
    offers.pop();
    if (free[best.vertex] == 0) continue;
    const std::uint32_t leader = graph.vertexOf(best.corner);
    const glm::dvec3 move = inset[best.corner];
    const double along =
        glm::dot(graph.vertices[best.vertex] - graph.vertices[leader], move) / glm::dot(move, move);
    if (along >= reach_mm) continue;
    free[best.vertex] = 0;
    followers.push_back({best.vertex, leader, best.corner, std::max(0.0, along)});
    for (std::uint32_t i = corners.first[best.vertex]; i < corners.first[best.vertex + 1]; ++i)
      offer(corners.list[i], best.corner);
  }
  return followers;
}

}  // namespace rangepose
