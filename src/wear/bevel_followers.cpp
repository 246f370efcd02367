#include "wear/bevel_followers.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace rangepose {
namespace {

/// Of the two ends of a ridge the nearer one leads.
constexpr double kEndShare = 0.01;

/// A vertex that may follow a leader; the one with the nearest ridge gets it.
struct Offer {
  double distance_mm;  ///< from the leader's ridges
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

/// Each vertex's neighbours along ridges.
class Ridges {
 public:
  explicit Ridges(const EdgeGraph& graph) : graph_(graph), next_(graph.vertices.size()) {
    for (const GraphEdge& edge : graph.edges) {
      if (!edge.ridge) continue;
      next_[edge.from].push_back(edge.to);
      next_[edge.to].push_back(edge.from);
    }
  }
  /// From a point to the ridges that end at a vertex [mm].
  double distance(const glm::dvec3& point, std::uint32_t vertex) const {
    const glm::dvec3 start = graph_.vertices[vertex];
    const double apart = glm::distance(point, start);
    double nearest = apart;
    for (const std::uint32_t next : next_[vertex]) {
      const glm::dvec3 along = graph_.vertices[next] - start;
      const double t = glm::dot(point - start, along) / glm::dot(along, along);
      nearest = std::min(nearest, glm::distance(point, start + std::clamp(t, 0.0, 1.0) * along));
    }
    return nearest + kEndShare * apart;
  }

 private:
  const EdgeGraph& graph_;
  std::vector<std::vector<std::uint32_t>> next_;
};

}  // namespace

std::vector<Follower> findFollowers(const EdgeGraph& graph,
                                    const std::vector<glm::dvec3>& inset,
                                    double edge_mm) {
  const double reach_mm = kFollowReach * edge_mm;
  std::vector<char> free = smoothVertices(graph);
  const Ridges ridges(graph);
  std::priority_queue<Offer> offers;
  const auto offer = [&](std::uint32_t corner, std::uint32_t leader) {
    for (const std::uint32_t next : {nextCorner(corner), nextCorner(nextCorner(corner))}) {
      const std::uint32_t vertex = graph.vertexOf(next);
      if (free[vertex] == 0) continue;
      const double distance = ridges.distance(graph.vertices[vertex], graph.vertexOf(leader));
      if (distance <= reach_mm) offers.push({distance, vertex, leader});
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
