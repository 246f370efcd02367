#include "wear/bevel.h"

#include <algorithm>
#include <cmath>

#include "wear/bevel_fans.h"

namespace rangepose {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;
constexpr std::size_t kLargest = 4;           ///< times as many triangles with two strips
constexpr std::size_t kAlwaysAllowed = 4000;  ///< triangles: small meshes may grow more
/// How far from the sharp corner the middle of its polygon lies, of the polygon's own distance: a
/// ball in the corner of a box.
constexpr double kCornerShare = 0.7;

class Bevel {
 public:
  Bevel(const EdgeGraph& graph, double edge_mm)
      : graph_(graph),
        fans_(bevelFans(graph, edge_mm)),
        staying_(graph.vertices.size(), kNone),
        fan_vertex_(fans_.fan.size(), kNone),
        shared_middle_(fans_.fan.size(), kNone) {}

  BevelledMesh build() {
    two_strips_ = roomForTwoStrips();
    result_.middle.assign(graph_.vertices.size(), kNone);
    for (std::uint32_t corner = 0; corner < fans_.fan.size(); corner += 3)
      add(vertexAt(corner), vertexAt(corner + 1), vertexAt(corner + 2));
    if (two_strips_) shareMiddles();
    for (const GraphEdge& edge : graph_.edges) {
      if (edge.ridge) addStrip(edge);
    }
    closeCorners();
    for (std::uint32_t corner = 0; corner < fans_.fan.size(); ++corner) {
      std::uint32_t& middle = result_.middle[graph_.vertexOf(corner)];
      const std::uint32_t shared = shared_middle_[fans_.umbrella[corner]];
      if (middle == kNone) middle = shared != kNone ? shared : vertexAt(corner);
    }
    return std::move(result_);
  }

 private:
  struct PolygonSide {
    std::uint32_t umbrella, from, to;
  };

  bool roomForTwoStrips() const {
    std::size_t count = graph_.triangles.size();
    for (const GraphEdge& edge : graph_.edges) count += edge.ridge ? 4 : 0;
    for (const int ridges : fans_.ridges) {
      if (ridges > 2) count += 2 * static_cast<std::size_t>(ridges);
    }
    return count <= std::max(kAlwaysAllowed, kLargest * graph_.triangles.size());
  }

  std::uint32_t newVertex(const glm::dvec3& position) {
    result_.vertices.push_back(position);
    return static_cast<std::uint32_t>(result_.vertices.size() - 1);
  }

  /// The vertex of the result at a corner of the graph.
  std::uint32_t vertexAt(std::uint32_t corner) {
    const std::uint32_t fan = fans_.fan[corner];
    const std::uint32_t vertex = graph_.vertexOf(corner);
    const bool stays = fans_.radius_mm[vertex] == 0.0 || fans_.inset[fan] == glm::dvec3(0.0);
    std::uint32_t& index = stays ? staying_[vertex] : fan_vertex_[fan];
    if (index == kNone) index = newVertex(fans_.moved(graph_, corner));
    return index;
  }

  /// Without area it's left out: its sides cancel each other.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) result_.triangles.emplace_back(a, b, c);
  }

  /// The top of the arc that touches both faces of a ridge where the corners `left` and `right`, of
  /// one umbrella, go.
  glm::dvec3 arcTop(const GraphEdge& edge, std::uint32_t left, std::uint32_t right) const {
    const glm::dvec3 start = graph_.vertices[edge.from];
    const glm::dvec3 along = glm::normalize(graph_.vertices[edge.to] - start);
    const glm::dvec3 chord = 0.5 * (fans_.moved(graph_, left) + fans_.moved(graph_, right));
    const glm::dvec3 on_ridge = start + glm::dot(chord - start, along) * along;
    const double cosine = glm::dot(graph_.normals[edge.left / 3], graph_.normals[edge.right / 3]);
    const double sine_half = std::sqrt(std::max(0.0, 0.5 * (1.0 + cosine)));
    return on_ridge + 1.0 / (1.0 + sine_half) * (chord - on_ridge);
  }

  /// Where two ridges meet the strips share their middle vertex: there is no corner to close.
  void shareMiddles() {
    std::vector<glm::dvec3> first(fans_.fan.size());
    std::vector<char> seen(fans_.fan.size(), 0);
    const auto collect = [&](const GraphEdge& edge, std::uint32_t left, std::uint32_t right) {
      const std::uint32_t umbrella = fans_.umbrella[left];
      if (fans_.ridges[umbrella] != 2 || vertexAt(left) == vertexAt(right)) return;
      const glm::dvec3 top = arcTop(edge, left, right);
      if (seen[umbrella] != 0) shared_middle_[umbrella] = newVertex(0.5 * (first[umbrella] + top));
      first[umbrella] = top;
      seen[umbrella] = 1;
    };
    for (const GraphEdge& edge : graph_.edges) {
      if (!edge.ridge) continue;
      collect(edge, edge.left, nextCorner(edge.right));
      collect(edge, nextCorner(edge.left), edge.right);
    }
  }

  std::uint32_t middleOf(const GraphEdge& edge, std::uint32_t left, std::uint32_t right) {
    if (vertexAt(left) == vertexAt(right)) return vertexAt(left);
    const std::uint32_t shared = shared_middle_[fans_.umbrella[left]];
    return shared != kNone ? shared : newVertex(arcTop(edge, left, right));
  }

  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    add(a, b, c);
    add(a, c, d);
  }

  void addStrip(const GraphEdge& edge) {
    const std::uint32_t to_corner = nextCorner(edge.left);
    const std::uint32_t from_corner = nextCorner(edge.right);
    const std::uint32_t from_left = vertexAt(edge.left);
    const std::uint32_t from_right = vertexAt(from_corner);
    const std::uint32_t to_left = vertexAt(to_corner);
    const std::uint32_t to_right = vertexAt(edge.right);
    const std::uint32_t at_from = fans_.umbrella[edge.left];
    const std::uint32_t at_to = fans_.umbrella[edge.right];
    if (!two_strips_) {
      addQuad(to_left, from_left, from_right, to_right);
      sides_.push_back({at_from, from_right, from_left});
      sides_.push_back({at_to, to_left, to_right});
      return;
    }
    const std::uint32_t from_middle = middleOf(edge, edge.left, from_corner);
    const std::uint32_t to_middle = middleOf(edge, to_corner, edge.right);
    addQuad(to_left, from_left, from_middle, to_middle);
    addQuad(to_middle, from_middle, from_right, to_right);
    sides_.push_back({at_from, from_right, from_middle});
    sides_.push_back({at_from, from_middle, from_left});
    sides_.push_back({at_to, to_left, to_middle});
    sides_.push_back({at_to, to_middle, to_right});
  }

  /// Fills the polygons that are left where three ridges or more meet. With two, the sides cancel.
  void closeCorners() {
    const auto useless = [&](const PolygonSide& side) {
      return side.from == side.to || fans_.ridges[side.umbrella] <= 2;
    };
    sides_.erase(std::remove_if(sides_.begin(), sides_.end(), useless), sides_.end());
    std::stable_sort(sides_.begin(), sides_.end(), [](const auto& a, const auto& b) {
      return a.umbrella < b.umbrella;
    });
    for (auto first = sides_.begin(); first != sides_.end();) {
      const std::uint32_t umbrella = first->umbrella;
      const auto last = std::find_if(
          first, sides_.end(), [&](const PolygonSide& side) { return side.umbrella != umbrella; });
      glm::dvec3 mean(0.0);
      std::for_each(first, last, [&](const auto& side) { mean += result_.vertices[side.from]; });
      mean /= static_cast<double>(last - first);
      const std::uint32_t vertex = graph_.vertexOf(umbrella);
      const glm::dvec3 corner = graph_.vertices[vertex];
      const std::uint32_t top = newVertex(corner + kCornerShare * (mean - corner));
      shared_middle_[umbrella] = top;
      for (; first != last; ++first) add(first->from, first->to, top);
    }
  }

  const EdgeGraph& graph_;
  BevelFans fans_;
  std::vector<std::uint32_t> staying_;        ///< of each vertex of the graph that stays
  std::vector<std::uint32_t> fan_vertex_;     ///< of each fan that moves
  std::vector<std::uint32_t> shared_middle_;  ///< of each umbrella
  std::vector<PolygonSide> sides_;
  BevelledMesh result_;
  bool two_strips_ = true;
};

}  // namespace

BevelledMesh bevelled(const EdgeGraph& graph, double edge_mm) {
  return Bevel(graph, edge_mm).build();
}

}  // namespace rangepose
