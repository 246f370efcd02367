#include "wear/openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "geometry/triangle_tree.h"

namespace rangepose {
namespace {

constexpr double kFlat = 0.02;       ///< largest distance from the plane, of the width
constexpr double kRound = 0.2;       ///< least share that a loop fills of the disc around it
constexpr double kFreeShare = 0.25;  ///< of its radius a rim's middle is away from the surface
constexpr int kProbes = 8;           ///< directions in which free space is looked for
constexpr double kAxisCos = 0.7;     ///< planes of the rims of one bore: 45 degrees
constexpr int kSteps = 16;           ///< along the axis of a bore

Mesh meshOf(const EdgeGraph& graph) {
  Mesh mesh;
  mesh.vertices.assign(graph.vertices.begin(), graph.vertices.end());
  mesh.triangles = graph.triangles;
  return mesh;
}

/// Where the surface is, and what lies within it.
class Material {
 public:
  explicit Material(const EdgeGraph& graph) : graph_(graph), tree_(meshOf(graph)) {}

  bool touches(const glm::dvec3& point, double reach_mm) const {
    return tree_.touches(point, reach_mm);
  }
  /// By most of three rays; each may meet an edge.
  bool contains(const glm::dvec3& point) const {
    constexpr std::array<glm::dvec3, 3> kRays = {glm::dvec3(0.5713, 0.3307, 0.7511),
                                                 glm::dvec3(-0.6131, 0.6871, -0.3899),
                                                 glm::dvec3(0.2377, -0.8219, 0.5178)};
    return std::count_if(kRays.begin(), kRays.end(), [&](const glm::dvec3& ray) {
             return oddCrossings(point, ray);
           }) >= 2;
  }

 private:
  bool oddCrossings(const glm::dvec3& point, const glm::dvec3& ray) const {
    bool odd = false;
    for (const glm::uvec3& triangle : graph_.triangles) {
      const glm::dvec3 a = graph_.vertices[triangle.x] - point;
      const glm::dvec3 b = graph_.vertices[triangle.y] - point;
      const glm::dvec3 c = graph_.vertices[triangle.z] - point;
      // Volumes over the sides, seen along the ray: of one sign where it passes within.
      const double u = glm::dot(ray, glm::cross(a, b));
      const double v = glm::dot(ray, glm::cross(b, c));
      const double w = glm::dot(ray, glm::cross(c, a));
      const bool within = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
      if (!within) continue;
      const double ahead = glm::dot(a, glm::cross(b, c)) * (u + v + w);
      if (ahead > 0.0) odd = !odd;
    }
    return odd;
  }

  const EdgeGraph& graph_;
  TriangleTree tree_;
};

/// The sides of triangles, each named after the corner at which it starts.
struct TriangleSides {
  explicit TriangleSides(const EdgeGraph& graph)
      : twin(3 * graph.triangles.size(), kNone), ridge(twin.size(), 0) {
    for (const GraphEdge& edge : graph.edges) {
      twin[edge.left] = edge.right;
      twin[edge.right] = edge.left;
      ridge[edge.left] = ridge[edge.right] = edge.ridge ? 1 : 0;
    }
  }
  /// The next ridge of the surface along whose boundary `side` runs; kNone where that has a gap.
  std::uint32_t nextRidge(std::uint32_t side) const {
    std::uint32_t next = nextCorner(side);
    while (ridge[next] == 0) {
      if (twin[next] == kNone) return kNone;
      next = nextCorner(twin[next]);
    }
    return next;
  }

  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::vector<std::uint32_t> twin;  ///< of each side: the same edge, the other way
  std::vector<char> ridge;
};

/// Closed loops of ridges around pieces of surface, each loop once.
std::vector<std::vector<std::uint32_t>> ridgeLoops(const EdgeGraph& graph) {
  const TriangleSides sides(graph);
  std::vector<std::vector<std::uint32_t>> loops;
  std::set<std::vector<std::uint32_t>> known;
  std::vector<char> seen(sides.ridge.size(), 0);
  for (std::uint32_t start = 0; start < seen.size(); ++start) {
    if (sides.ridge[start] == 0) continue;
    std::vector<std::uint32_t> loop;
    std::uint32_t side = start;
    while (side != TriangleSides::kNone && seen[side] == 0) {
      seen[side] = 1;
      loop.push_back(graph.vertexOf(side));
      side = sides.nextRidge(side);
    }
    if (side != start || loop.size() < 3) continue;
    std::vector<std::uint32_t> name = loop;
    std::sort(name.begin(), name.end());
    if (known.insert(std::move(name)).second) loops.push_back(std::move(loop));
  }
  return loops;
}

/// Width, middle and axis of a loop. Width 0: it's not flat or not round enough.
Rim measured(const EdgeGraph& graph, const std::vector<std::uint32_t>& loop) {
  Rim rim;
  rim.loop = loop;
  const auto at = [&](std::size_t i) { return graph.vertices[loop[i % loop.size()]]; };
  glm::dvec3 mean(0.0);
  for (std::size_t i = 0; i < loop.size(); ++i) mean += at(i);
  mean /= static_cast<double>(loop.size());
  glm::dvec3 twice_area(0.0);
  for (std::size_t i = 0; i < loop.size(); ++i)
    twice_area += glm::cross(at(i) - mean, at(i + 1) - mean);
  const double length = glm::length(twice_area);
  if (length == 0.0) return rim;
  rim.axis = twice_area / length;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double share = glm::dot(glm::cross(at(i) - mean, at(i + 1) - mean), rim.axis) / length;
    rim.middle_mm += share / 3.0 * (mean + at(i) + at(i + 1));
  }
  const double width = std::sqrt(2.0 / std::numbers::pi * length);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const glm::dvec3 from_middle = at(i) - rim.middle_mm;
    const glm::dvec3 turn = glm::cross(from_middle, at(i + 1) - rim.middle_mm);
    const bool flat = std::abs(glm::dot(from_middle, rim.axis)) <= kFlat * width;
    const bool round = kRound * glm::dot(from_middle, from_middle) <= 0.25 * width * width;
    if (!flat || !round || glm::dot(turn, rim.axis) <= 0.0) return rim;
  }
  rim.width_mm = width;
  return rim;
}

bool isFree(const EdgeGraph& graph, const Material& material, const Rim& rim) {
  if (material.touches(rim.middle_mm, kFreeShare * 0.5 * rim.width_mm)) return false;
  const std::size_t count = rim.loop.size();
  for (int probe = 0; probe < kProbes; ++probe) {
    const std::size_t i = static_cast<std::size_t>(probe) * count / kProbes;
    const glm::dvec3 edge_middle =
        0.5 * (graph.vertices[rim.loop[i]] + graph.vertices[rim.loop[(i + 1) % count]]);
    const glm::dvec3 inward = rim.middle_mm - edge_middle;
    const double reach = glm::length(inward);
    const glm::dvec3 next_to_rim = edge_middle + 0.05 * inward;
    // Next to the rim there is a bore, not a face or the bevel of one; nothing stands in its way.
    if (material.touches(next_to_rim, 0.02 * reach)) return false;
    if (material.touches(edge_middle + 0.5 * inward, 0.1 * reach)) return false;
    if (probe % 4 == 0 && material.contains(next_to_rim)) return false;
  }
  return !material.contains(rim.middle_mm);
}

/// Whether the way from one middle to the other is free, with the wall of a bore around it.
bool isBore(const Material& material, const Rim& a, const Rim& b) {
  const double radius = 0.25 * (a.width_mm + b.width_mm);
  for (int step = 0; step <= kSteps; ++step) {
    const glm::dvec3 point = glm::mix(a.middle_mm, b.middle_mm, static_cast<double>(step) / kSteps);
    if (material.touches(point, kFreeShare * radius)) return false;
    if (!material.touches(point, 1.5 * radius)) return false;
  }
  return true;
}

/// Whether the middle of one rim lies on the axis of the other.
bool inLine(const Rim& rim, const Rim& other) {
  const glm::dvec3 way = other.middle_mm - rim.middle_mm;
  const double aside = glm::length(way - glm::dot(way, rim.axis) * rim.axis);
  return aside <= 0.1 * rim.width_mm;
}

/// The farthest rim that the bore of this one leads to: the near ones belong to chamfers. A bore
/// may end in a slanted face.
int otherEnd(const Material& material, const std::vector<Rim>& rims, std::size_t index) {
  const Rim& rim = rims[index];
  int best = -1;
  double farthest = 0.0;
  for (std::size_t k = 0; k < rims.size(); ++k) {
    const double distance = glm::distance(rims[k].middle_mm, rim.middle_mm);
    const bool alike = std::abs(glm::dot(rims[k].axis, rim.axis)) >= kAxisCos &&
                       std::abs(rims[k].width_mm - rim.width_mm) <= 0.5 * rim.width_mm;
    if (k == index || !alike || distance <= farthest) continue;
    if (!inLine(rim, rims[k]) && !inLine(rims[k], rim)) continue;
    if (!isBore(material, rim, rims[k])) continue;
    farthest = distance;
    best = static_cast<int>(k);
  }
  return best;
}

}  // namespace

std::vector<Rim> findRims(const EdgeGraph& graph, double smallest_mm, double largest_mm) {
  const Material material(graph);
  std::vector<Rim> rims;
  for (const std::vector<std::uint32_t>& loop : ridgeLoops(graph)) {
    Rim rim = measured(graph, loop);
    if (rim.width_mm == 0.0 || rim.width_mm < smallest_mm || rim.width_mm > largest_mm) continue;
    if (isFree(graph, material, rim)) rims.push_back(std::move(rim));
  }
  for (std::size_t k = 0; k < rims.size(); ++k) rims[k].other = otherEnd(material, rims, k);
  return rims;
}

}  // namespace rangepose
