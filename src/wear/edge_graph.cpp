#include "wear/edge_graph.h"

#include <algorithm>
#include <tuple>

#include "wear/flat_flips.h"

namespace rangepose {
namespace {

/// Triangles lower than this share of the part's radius are needles: positions in single precision
/// leave their normal to chance.
constexpr double kNeedleShare = 2e-5;
/// A needle's neighbour may be one, too: so often normals are handed on.
constexpr int kNeedlePasses = 8;

/// A triangle's side from its smaller to its larger vertex.
struct Side {
  std::uint32_t low, high;
  std::uint32_t corner;  ///< where the triangle's side starts
  bool operator<(const Side& other) const {
    return std::tie(low, high, corner) < std::tie(other.low, other.high, other.corner);
  }
};

/// Equal positions become one vertex, in the order of their first use.
void weld(const Mesh& mesh, EdgeGraph& graph) {
  const auto place = [&](std::uint32_t i) {
    const glm::vec3& v = mesh.vertices[i];
    return std::make_tuple(v.x, v.y, v.z);
  };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return place(a) < place(b); });
  std::vector<std::uint32_t> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && place(order[i]) == place(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  constexpr std::uint32_t kUnused = 0xffffffffU;
  std::vector<std::uint32_t> renamed(first.size(), kUnused);
  for (const glm::uvec3& corners : mesh.triangles) {
    glm::uvec3 triangle{};
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& name = renamed[first[corners[k]]];
      if (name == kUnused) {
        name = static_cast<std::uint32_t>(graph.vertices.size());
        graph.vertices.emplace_back(mesh.vertices[corners[k]]);
      }
      triangle[k] = name;
    }
    if (triangle.x != triangle.y && triangle.y != triangle.z && triangle.z != triangle.x)
      graph.triangles.push_back(triangle);
  }
}

void findEdges(EdgeGraph& graph) {
  std::vector<Side> sides;
  sides.reserve(3 * graph.triangles.size());
  for (std::uint32_t corner = 0; corner < 3 * graph.triangles.size(); ++corner) {
    const std::uint32_t a = graph.vertexOf(corner);
    const std::uint32_t b = graph.vertexOf(nextCorner(corner));
    sides.push_back({std::min(a, b), std::max(a, b), corner});
  }
  std::sort(sides.begin(), sides.end());
  graph.edges.clear();
  graph.awkward.assign(graph.vertices.size(), 0);
  for (std::size_t i = 0; i < sides.size();) {
    const Side& side = sides[i];
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == side.low && sides[end].high == side.high) ++end;
    const std::uint32_t from = graph.vertexOf(side.corner);
    if (end - i == 2 && graph.vertexOf(sides[i + 1].corner) != from) {
      const std::uint32_t to = from == side.low ? side.high : side.low;
      graph.edges.push_back({from, to, side.corner, sides[i + 1].corner});
    } else {
      graph.awkward[side.low] = 1;
      graph.awkward[side.high] = 1;
    }
    i = end;
  }
}

/// The corner at which a triangle's longest side starts.
std::uint32_t longestSide(const EdgeGraph& graph, std::uint32_t triangle) {
  std::uint32_t best = 3 * triangle;
  double best_squared = -1.0;
  for (std::uint32_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
    const glm::dvec3 side =
        graph.vertices[graph.vertexOf(nextCorner(corner))] - graph.vertices[graph.vertexOf(corner)];
    if (glm::dot(side, side) <= best_squared) continue;
    best = corner;
    best_squared = glm::dot(side, side);
  }
  return best;
}

void findNormals(EdgeGraph& graph, double lowest_mm) {
  graph.normals.assign(graph.triangles.size(), glm::dvec3(0.0));
  graph.needle.assign(graph.triangles.size(), 0);
  std::vector<std::uint32_t> longest(graph.triangles.size());
  for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
    longest[t] = longestSide(graph, t);
    const glm::dvec3 cross = graph.cross(t);
    const double length = glm::distance(graph.vertices[graph.vertexOf(longest[t])],
                                        graph.vertices[graph.vertexOf(nextCorner(longest[t]))]);
    graph.needle[t] = glm::length(cross) < lowest_mm * length ? 1 : 0;
    if (graph.needle[t] == 0) graph.normals[t] = glm::normalize(cross);
  }
  for (int pass = 0; pass < kNeedlePasses; ++pass) {
    for (const GraphEdge& edge : graph.edges) {
      const std::uint32_t left = edge.left / 3;
      const std::uint32_t right = edge.right / 3;
      const auto take = [&](std::uint32_t triangle, std::uint32_t corner, std::uint32_t other) {
        const bool has = graph.normals[triangle] != glm::dvec3(0.0);
        if (!has && longest[triangle] == corner) graph.normals[triangle] = graph.normals[other];
      };
      take(left, edge.left, right);
      take(right, edge.right, left);
    }
  }
}

}  // namespace

glm::dvec3 EdgeGraph::cross(std::size_t triangle) const {
  const glm::uvec3& t = triangles[triangle];
  return glm::cross(vertices[t.y] - vertices[t.x], vertices[t.z] - vertices[t.x]);
}

EdgeGraph edgeGraph(const Mesh& mesh) {
  checkMesh(mesh);
  EdgeGraph graph;
  weld(mesh, graph);
  const double lowest_mm = kNeedleShare * boundingSphere(mesh).radius_mm;
  findEdges(graph);
  findNormals(graph, lowest_mm);
  flipFlatEdges(graph);
  findEdges(graph);
  findNormals(graph, lowest_mm);
  for (GraphEdge& edge : graph.edges) {
    const glm::dvec3& left = graph.normals[edge.left / 3];
    const glm::dvec3& right = graph.normals[edge.right / 3];
    if (left == glm::dvec3(0.0) || right == glm::dvec3(0.0)) continue;
    const glm::dvec3 along = graph.vertices[edge.to] - graph.vertices[edge.from];
    edge.sharp = glm::dot(left, right) < kSharpCos;
    edge.ridge = edge.sharp && glm::dot(glm::cross(left, right), along) > 0.0;
  }
  return graph;
}

}  // namespace rangepose
