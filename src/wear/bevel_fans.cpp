#include "wear/bevel_fans.h"

#include <algorithm>
#include <cmath>

#include "wear/bevel_followers.h"

namespace rangepose {
namespace {

constexpr double kLongestInset = 1.5;  ///< of the radius, in acute corners of a face
constexpr double kKept = 0.4;          ///< share of an area or a length that must be left
constexpr double kTurnedCos = 0.8;     ///< a triangle may turn by 37 degrees
constexpr double kTaper = 0.5;         ///< change of the radius along a ridge, of the length
constexpr double kLess = 0.75;         ///< a radius that is too large becomes so much of it
constexpr int kPasses = 24;            ///< then what is still too large becomes 0

/// What bounds a fan.
struct FanSides {
  glm::dvec3 inward_sum{0.0};  ///< unit vectors in the surface, across the ridges
  glm::dvec3 first_inward{0.0};
  glm::dvec3 second_inward{0.0};
  int ridges = 0;
  glm::dvec3 valley{0.0};  ///< unit vector along a sharp edge that is no ridge, within the fan
  int valleys = 0;
};

void addRidge(FanSides& sides, const glm::dvec3& inward) {
  (sides.ridges == 0 ? sides.first_inward : sides.second_inward) = inward;
  ++sides.ridges;
}

/// Away from both ridges by 1 mm, if that takes no more than kLongestInset. Zero where the fan has
/// to stay.
glm::dvec3 insetOf(const FanSides& sides) {
  if (sides.ridges != 2 || sides.valleys > 1) return glm::dvec3(0.0);
  const glm::dvec3& a = sides.first_inward;
  const glm::dvec3& b = sides.second_inward;
  if (sides.valleys == 1) {
    // Only along the valley it stays in both faces.
    const double gain = std::min(glm::dot(sides.valley, a), glm::dot(sides.valley, b));
    if (gain < 0.2) return glm::dvec3(0.0);
    return std::min(kLongestInset, 1.0 / gain) * sides.valley;
  }
  const glm::dvec3 sum = a + b;
  const double length = glm::length(sum);
  if (length < 1e-3) return glm::dvec3(0.0);
  return std::min(kLongestInset, 2.0 / length) / length * sum;
}

std::vector<FanSides> fanSides(const EdgeGraph& graph, const std::vector<std::uint32_t>& fan) {
  std::vector<FanSides> sides(fan.size());
  for (const GraphEdge& edge : graph.edges) {
    if (!edge.sharp) continue;
    const glm::dvec3 along = glm::normalize(graph.vertices[edge.to] - graph.vertices[edge.from]);
    if (edge.ridge) {
      const glm::dvec3 left = glm::cross(graph.normals[edge.left / 3], along);
      const glm::dvec3 right = glm::cross(along, graph.normals[edge.right / 3]);
      addRidge(sides[fan[edge.left]], left);
      addRidge(sides[fan[nextCorner(edge.left)]], left);
      addRidge(sides[fan[edge.right]], right);
      addRidge(sides[fan[nextCorner(edge.right)]], right);
      continue;
    }
    FanSides& at_from = sides[fan[edge.left]];
    FanSides& at_to = sides[fan[edge.right]];
    at_from.valley = along;
    at_to.valley = -along;
    ++at_from.valleys;
    ++at_to.valleys;
  }
  return sides;
}

/// Fans and umbrellas, each named after one of its corners.
void connect(const EdgeGraph& graph, BevelFans& fans) {
  const std::size_t corners = 3 * graph.triangles.size();
  DisjointSets fan_sets(corners);
  DisjointSets umbrella_sets(corners);
  for (const GraphEdge& edge : graph.edges) {
    umbrella_sets.join(edge.left, nextCorner(edge.right));
    umbrella_sets.join(nextCorner(edge.left), edge.right);
    if (edge.ridge) continue;
    fan_sets.join(edge.left, nextCorner(edge.right));
    fan_sets.join(nextCorner(edge.left), edge.right);
  }
  fans.fan.resize(corners);
  fans.umbrella.resize(corners);
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    fans.fan[corner] = fan_sets.rootOf(corner);
    fans.umbrella[corner] = umbrella_sets.rootOf(corner);
  }
  fans.ridges.assign(corners, 0);
  for (const GraphEdge& edge : graph.edges) {
    if (!edge.ridge) continue;
    ++fans.ridges[fans.umbrella[edge.left]];
    ++fans.ridges[fans.umbrella[edge.right]];
  }
}

/// Of the triangle over its longest side.
double height(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  return longest > 0.0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0.0;
}

/// Whether a triangle keeps its side and enough of its area, or is too thin to be seen before and
/// after.
bool triangleIsSound(const EdgeGraph& graph,
                     const BevelFans& fans,
                     std::uint32_t triangle,
                     double thin_mm) {
  const std::uint32_t corner = 3 * triangle;
  const glm::dvec3 a = fans.moved(graph, corner);
  const glm::dvec3 b = fans.moved(graph, corner + 1);
  const glm::dvec3 c = fans.moved(graph, corner + 2);
  const double before = glm::length(graph.cross(triangle));
  const glm::dvec3 now = glm::cross(b - a, c - a);
  const double facing = glm::dot(now, graph.normals[triangle]);
  const bool needle = graph.needle[triangle] != 0;
  if (needle && facing >= -2.0 * before) return true;
  if (!needle && facing >= kKept * before && facing >= kTurnedCos * glm::length(now)) return true;
  const glm::uvec3& corners = graph.triangles[triangle];
  return height(a, b, c) <= thin_mm &&
         height(graph.vertices[corners.x], graph.vertices[corners.y], graph.vertices[corners.z]) <=
             thin_mm;
}

bool edgeIsSound(const EdgeGraph& graph,
                 const BevelFans& fans,
                 const GraphEdge& edge,
                 double thin_mm) {
  const glm::dvec3 before = graph.vertices[edge.to] - graph.vertices[edge.from];
  const glm::dvec3 left = fans.moved(graph, nextCorner(edge.left)) - fans.moved(graph, edge.left);
  const glm::dvec3 right =
      fans.moved(graph, edge.right) - fans.moved(graph, nextCorner(edge.right));
  const double kept = std::min(glm::dot(left, before), glm::dot(right, before));
  if (kept >= kKept * glm::dot(before, before)) return true;
  return std::max({glm::length(before), glm::length(left), glm::length(right)}) <= thin_mm;
}

/// Makes the radius change gently along ridges, forth and back.
void taper(const EdgeGraph& graph, std::vector<double>& radius_mm) {
  const auto limit = [&](const GraphEdge& edge) {
    if (!edge.ridge) return;
    double& a = radius_mm[edge.from];
    double& b = radius_mm[edge.to];
    const double change =
        kTaper * glm::distance(graph.vertices[edge.from], graph.vertices[edge.to]);
    a = std::min(a, b + change);
    b = std::min(b, a + change);
  };
  std::for_each(graph.edges.begin(), graph.edges.end(), limit);
  std::for_each(graph.edges.rbegin(), graph.edges.rend(), limit);
}

/// Vertices of triangles and edges that suffer too much.
std::vector<char> tooFar(const EdgeGraph& graph, const BevelFans& fans, double thin_mm) {
  std::vector<char> too_far(graph.vertices.size(), 0);
  for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
    if (triangleIsSound(graph, fans, t, thin_mm)) continue;
    for (int k = 0; k < 3; ++k) too_far[graph.triangles[t][k]] = 1;
  }
  for (const GraphEdge& edge : graph.edges) {
    if (!edge.ridge || edgeIsSound(graph, fans, edge, thin_mm)) continue;
    too_far[edge.from] = 1;
    too_far[edge.to] = 1;
  }
  return too_far;
}

/// Followers move as far as their leaders at the ridge, and not at all at the end of its reach.
void follow(const std::vector<Follower>& followers, double reach, std::vector<double>& radius_mm) {
  for (const Follower& follower : followers) {
    radius_mm[follower.vertex] =
        std::max(0.0, radius_mm[follower.leader] - follower.distance_mm / reach);
  }
}

/// Ends: each pass past kPasses that finds something lets vertices stay for good, and a triangle or
/// an edge whose vertices all stay is sound.
void shrinkRadii(const EdgeGraph& graph,
                 const std::vector<Follower>& followers,
                 double thin_mm,
                 BevelFans& fans) {
  for (int pass = 0;; ++pass) {
    taper(graph, fans.radius_mm);
    follow(followers, kFollowReach, fans.radius_mm);
    std::vector<char> too_far = tooFar(graph, fans, thin_mm);
    for (const Follower& follower : followers) {
      if (too_far[follower.vertex] != 0) too_far[follower.leader] = 1;
    }
    bool any = false;
    for (std::size_t v = 0; v < too_far.size(); ++v) {
      if (too_far[v] == 0 || fans.radius_mm[v] == 0.0) continue;
      fans.radius_mm[v] = pass < kPasses ? kLess * fans.radius_mm[v] : 0.0;
      any = true;
    }
    if (!any) return;
  }
}

/// Lets smooth surface near ridges move along, within its own planes.
std::vector<Follower> addFollowers(const EdgeGraph& graph, double edge_mm, BevelFans& fans) {
  std::vector<glm::dvec3> inset(fans.fan.size());
  for (std::size_t corner = 0; corner < inset.size(); ++corner)
    inset[corner] = fans.inset[fans.fan[corner]];
  std::vector<Follower> followers = findFollowers(graph, inset, edge_mm);
  std::vector<std::uint32_t> fan_of_vertex(graph.vertices.size());
  std::vector<glm::dvec3> normal(graph.vertices.size(), glm::dvec3(0.0));
  for (std::uint32_t corner = 0; corner < inset.size(); ++corner) {
    fan_of_vertex[graph.vertexOf(corner)] = fans.fan[corner];
    normal[graph.vertexOf(corner)] += graph.normals[corner / 3];
  }
  for (const Follower& follower : followers) {
    const glm::dvec3& sum = normal[follower.vertex];
    if (glm::dot(sum, sum) == 0.0) continue;  // between needles
    const glm::dvec3 up = glm::normalize(sum);
    const glm::dvec3& move = inset[follower.corner];
    fans.inset[fan_of_vertex[follower.vertex]] = move - glm::dot(move, up) * up;
  }
  return followers;
}

}  // namespace

BevelFans bevelFans(const EdgeGraph& graph, double edge_mm) {
  BevelFans fans;
  connect(graph, fans);
  for (const FanSides& sides : fanSides(graph, fans.fan)) fans.inset.push_back(insetOf(sides));
  for (std::uint32_t corner = 0; corner < fans.fan.size(); ++corner) {
    // A ridge that ends in the surface: the rounding tapers off.
    if (fans.ridges[fans.umbrella[corner]] == 1) fans.inset[fans.fan[corner]] = glm::dvec3(0.0);
  }
  fans.radius_mm.assign(graph.vertices.size(), edge_mm);
  for (std::size_t v = 0; v < fans.radius_mm.size(); ++v) {
    if (graph.awkward[v] != 0) fans.radius_mm[v] = 0.0;
  }
  shrinkRadii(graph, addFollowers(graph, edge_mm, fans), unseenBy(edge_mm), fans);
  return fans;
}

}  // namespace rangepose
