#include "wear/flat_flips.h"

#include <array>

namespace rangepose {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;
constexpr double kFlatCos = 1.0 - 1e-5;  ///< 0.26 degrees
constexpr double kClearSine = 1e-6;      ///< below it two diagonals count as equally good
constexpr std::size_t kMostFlips = 20;   ///< times the triangles; should rounding never end it

class Flipper {
 public:
  explicit Flipper(EdgeGraph& graph) : graph_(graph), twin_(3 * graph.triangles.size(), kNone) {
    for (const GraphEdge& edge : graph.edges) pair(edge.left, edge.right);
  }

  void run() {
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t side = 0; side < twin_.size(); ++side) waiting.push_back(side);
    std::size_t left = kMostFlips * graph_.triangles.size();
    while (!waiting.empty() && left > 0) {
      const std::uint32_t side = waiting.back();
      waiting.pop_back();
      if (!isWorthFlipping(side)) continue;
      for (const std::uint32_t border : flip(side)) waiting.push_back(border);
      --left;
    }
  }

 private:
  void pair(std::uint32_t a, std::uint32_t b) {
    twin_[a] = b;
    if (b != kNone) twin_[b] = a;
  }
  const glm::dvec3& at(std::uint32_t corner) const {
    return graph_.vertices[graph_.vertexOf(corner)];
  }

  /// The side from a to b, its triangle's third corner p, the other triangle's q.
  bool isWorthFlipping(std::uint32_t side) const {
    const std::uint32_t other = twin_[side];
    if (other == kNone) return false;
    const glm::dvec3& normal = graph_.normals[side / 3];
    if (glm::dot(normal, graph_.normals[other / 3]) < kFlatCos) return false;
    const glm::dvec3 a = at(side);
    const glm::dvec3 b = at(nextCorner(side));
    const glm::dvec3 p = at(nextCorner(nextCorner(side)));
    const glm::dvec3 q = at(nextCorner(nextCorner(other)));
    const auto turn = [&](const glm::dvec3& u, const glm::dvec3& v) {
      return glm::dot(normal, glm::cross(u, v));
    };
    const double size = glm::dot(p - q, p - q);
    const bool convex =
        turn(b - q, p - q) > kClearSine * size && turn(a - p, q - p) > kClearSine * size;
    // The sine of the sum of the angles at p and q: negative beyond 180 degrees.
    const double sine =
        turn(a - p, b - p) * glm::dot(b - q, a - q) + turn(b - q, a - q) * glm::dot(a - p, b - p);
    const double scale =
        glm::length(a - p) * glm::length(b - p) * glm::length(a - q) * glm::length(b - q);
    return convex && sine < -kClearSine * scale;
  }

  /// Returns the sides of the quadrangle.
  std::array<std::uint32_t, 4> flip(std::uint32_t side) {
    const std::uint32_t other = twin_[side];
    const std::uint32_t first = 3 * (side / 3);
    const std::uint32_t second = 3 * (other / 3);
    const std::uint32_t a = graph_.vertexOf(side);
    const std::uint32_t b = graph_.vertexOf(other);
    const std::uint32_t p = graph_.vertexOf(nextCorner(nextCorner(side)));
    const std::uint32_t q = graph_.vertexOf(nextCorner(nextCorner(other)));
    const std::uint32_t beyond_bp = twin_[nextCorner(side)];
    const std::uint32_t beyond_pa = twin_[nextCorner(nextCorner(side))];
    const std::uint32_t beyond_aq = twin_[nextCorner(other)];
    const std::uint32_t beyond_qb = twin_[nextCorner(nextCorner(other))];
    graph_.triangles[side / 3] = {q, b, p};
    graph_.triangles[other / 3] = {p, a, q};
    pair(first, beyond_qb);
    pair(first + 1, beyond_bp);
    pair(second, beyond_pa);
    pair(second + 1, beyond_aq);
    pair(first + 2, second + 2);
    return {first, first + 1, second, second + 1};
  }

  EdgeGraph& graph_;
  std::vector<std::uint32_t> twin_;
};

}  // namespace

void flipFlatEdges(EdgeGraph& graph) { Flipper(graph).run(); }

}  // namespace rangepose
