#include "geometry/solid.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/triangle_corners.h"

namespace rangepose {
namespace {

using Index = std::uint32_t;

/// For each vertex the first one at its place.
std::vector<Index> welded(const Mesh& mesh) {
  std::vector<Index> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto place = [&](Index i) {
    const glm::vec3& v = mesh.vertices[i];
    return std::make_tuple(v.x, v.y, v.z);
  };
  std::stable_sort(
      order.begin(), order.end(), [&](Index a, Index b) { return place(a) < place(b); });
  std::vector<Index> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && place(order[i]) == place(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// An edge from its smaller to its larger vertex, and whether a triangle uses it that way.
struct Edge {
  Index low;
  Index high;
  int way;
  bool operator<(const Edge& other) const {
    return std::tie(low, high) < std::tie(other.low, other.high);
  }
};

bool balanced(std::vector<Edge> edges) {
  std::sort(edges.begin(), edges.end());
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto end = std::upper_bound(edge, edges.end(), *edge);
    int balance = 0;
    for (; edge != end; ++edge) balance += edge->way;
    if (balance != 0) return false;
  }
  return true;
}

bool isClosed(const Mesh& mesh, const std::vector<Index>& weld) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index a = weld[triangle[k]];
      const Index b = weld[triangle[(k + 1) % 3]];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  return balanced(std::move(edges));
}

/// The vertex that stands for all that `vertex` is connected to.
Index rootOf(std::vector<Index>& parent, Index vertex) {
  while (parent[vertex] != vertex) {
    parent[vertex] = parent[parent[vertex]];
    vertex = parent[vertex];
  }
  return vertex;
}

}  // namespace

bool isClosed(const Mesh& mesh) { return isClosed(mesh, welded(mesh)); }

bool isSolid(const Mesh& mesh) {
  const std::vector<Index> weld = welded(mesh);
  if (mesh.triangles.empty() || !isClosed(mesh, weld)) return false;
  std::vector<Index> parent = weld;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 1; k < 3; ++k)
      parent[rootOf(parent, weld[triangle[k]])] = rootOf(parent, weld[triangle[0]]);
  }
  // Volumes of the pyramids over the triangles, from a point that is near all of them.
  const glm::dvec3 origin = boundingBoxCenter(mesh);
  std::vector<double> volume(mesh.vertices.size(), 0.0);
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners corners(mesh, triangle);
    volume[rootOf(parent, weld[triangle[0]])] += glm::dot(corners.a - origin, corners.cross());
  }
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::uvec3& triangle) {
    return volume[rootOf(parent, weld[triangle[0]])] > 0.0;
  });
}

}  // namespace rangepose
