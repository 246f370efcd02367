#include "wear/wear.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "sim/random.h"
#include "wear/bevel.h"
#include "wear/edge_graph.h"
#include "wear/openings.h"

namespace rangepose {
namespace {

constexpr double kSmallestHole = 0.02;  ///< widths, of the part's diameter
constexpr double kLargestHole = 0.12;
constexpr double kLargestOpening = 0.6;
constexpr double kSmallestShiny = 0.05;  ///< shares of the part's area
constexpr double kLargestShiny = 0.25;

/// All that chance decides; drawn at once, so that each value stays the same whatever the others
/// are used for. All but the factor in [0, 1).
struct Draws {
  double factor;
  double hole, which_hole;
  double opening, which_opening;
  double shiny, which_shiny;
};

Draws draw(std::uint64_t seed, double scale) {
  Random random(seed);
  Draws draws{};
  draws.factor = 1.0 + random.uniform(-scale, scale);
  draws.hole = random.uniform();
  draws.which_hole = random.uniform();
  draws.opening = random.uniform();
  draws.which_opening = random.uniform();
  draws.shiny = random.uniform();
  draws.which_shiny = random.uniform();
  return draws;
}

std::size_t choice(double draw, std::size_t count) {
  return std::min(static_cast<std::size_t>(draw * static_cast<double>(count)), count - 1);
}

/// Triangles of each smooth face that has neither too little nor too much of the area.
std::vector<std::vector<std::uint32_t>> smoothFaces(const EdgeGraph& graph) {
  DisjointSets faces(graph.triangles.size());
  for (const GraphEdge& edge : graph.edges) {
    if (!edge.sharp) faces.join(edge.left / 3, edge.right / 3);
  }
  std::vector<std::vector<std::uint32_t>> members(graph.triangles.size());
  std::vector<double> area(graph.triangles.size(), 0.0);
  double whole = 0.0;
  for (std::uint32_t t = 0; t < graph.triangles.size(); ++t) {
    const double twice = glm::length(graph.cross(t));
    members[faces.rootOf(t)].push_back(t);
    area[faces.rootOf(t)] += twice;
    whole += twice;
  }
  std::vector<std::vector<std::uint32_t>> chosen;
  for (std::size_t face = 0; face < members.size(); ++face) {
    if (area[face] >= kSmallestShiny * whole && area[face] <= kLargestShiny * whole)
      chosen.push_back(members[face]);
  }
  return chosen;
}

/// A lid with a face on either side.
void close(const Rim& rim, BevelledMesh& part) {
  const auto middle = static_cast<std::uint32_t>(part.vertices.size());
  part.vertices.push_back(rim.middle_mm);
  for (std::size_t i = 0; i < rim.loop.size(); ++i) {
    const std::uint32_t a = part.middle[rim.loop[i]];
    const std::uint32_t b = part.middle[rim.loop[(i + 1) % rim.loop.size()]];
    if (a == b) continue;
    part.triangles.emplace_back(a, b, middle);
    part.triangles.emplace_back(b, a, middle);
  }
}

void closeSome(const EdgeGraph& graph,
               double diameter_mm,
               const WearOptions& options,
               const Draws& draws,
               BevelledMesh& part) {
  const bool hole = draws.hole < options.hole_closed;
  const bool opening = draws.opening < options.opening_closed;
  if (!hole && !opening) return;
  const std::vector<Rim> rims =
      findRims(graph, kSmallestHole * diameter_mm, kLargestOpening * diameter_mm);
  std::vector<const Rim*> holes;
  std::vector<const Rim*> openings;
  for (const Rim& rim : rims)
    (rim.width_mm <= kLargestHole * diameter_mm ? holes : openings).push_back(&rim);
  if (hole && !holes.empty()) {
    const Rim& rim = *holes[choice(draws.which_hole, holes.size())];
    close(rim, part);
    if (rim.other >= 0) close(rims[static_cast<std::size_t>(rim.other)], part);
  }
  if (opening && !openings.empty())
    close(*openings[choice(draws.which_opening, openings.size())], part);
}

/// The shiny triangles alone, in the worn part's vertices.
Mesh shinyFace(const EdgeGraph& graph, const Mesh& worn, double which) {
  const std::vector<std::vector<std::uint32_t>> faces = smoothFaces(graph);
  if (faces.empty()) return {};
  Mesh shiny;
  shiny.name = worn.name;
  shiny.vertices = worn.vertices;
  for (const std::uint32_t triangle : faces[choice(which, faces.size())])
    shiny.triangles.push_back(worn.triangles[triangle]);
  return cleaned(shiny);
}

void checkChance(double value, const char* name) {
  RP_CHECK(value >= 0.0 && value <= 1.0, std::string("wear: ") + name + " must be 0 to 1");
}

}  // namespace

void WearOptions::check() const {
  RP_CHECK(scale >= 0.0 && scale <= 0.2, "wear: scale must be 0 to 0.2");
  RP_CHECK(edge_mm >= 0.0 && std::isfinite(edge_mm), "wear: edge_mm must not be negative");
  checkChance(hole_closed, "hole_closed");
  checkChance(opening_closed, "opening_closed");
  checkChance(shiny, "shiny");
}

WornPart wornPart(const Mesh& cad, const WearOptions& options, std::uint64_t seed) {
  options.check();
  const EdgeGraph graph = edgeGraph(cad);
  const Draws draws = draw(seed, options.scale);
  BevelledMesh part = bevelled(graph, options.edge_mm);
  closeSome(graph, diameter(cad), options, draws, part);
  WornPart worn;
  worn.mesh.name = cad.name;
  worn.mesh.solid = cad.solid;  // lids have no back, either
  worn.mesh.triangles = part.triangles;
  const glm::dvec3 center = boundingSphere(cad).center_mm;
  for (const glm::dvec3& vertex : part.vertices)
    worn.mesh.vertices.emplace_back(center + draws.factor * (vertex - center));
  if (draws.shiny < options.shiny) worn.shiny = shinyFace(graph, worn.mesh, draws.which_shiny);
  return worn;
}

}  // namespace rangepose
