#include "sim/heap.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "sim/height_field.h"
#include "sim/random.h"

namespace rangepose {
namespace {

struct Placement {
  glm::dmat3 rotation{1.0};
  glm::dvec2 at_mm{0.0};
  double height_mm = 0.0;  ///< of the centre of mass
};

struct Part {
  const Mesh& mesh;
  glm::dvec3 center_mm;
};

void settleHeight(const Part& part, const HeapTop& heap, Placement& placement) {
  placement.height_mm = heap.restingHeight(
      columnsOf(part.mesh, part.center_mm, placement.rotation, placement.at_mm, heap.cellMm()));
}

Placement lowestDrop(
    const Part& part, const HeapTop& heap, double radius_mm, int drops, Random& random) {
  Placement best;
  for (int k = 0; k < drops; ++k) {
    Placement candidate{random.rotation(), radius_mm * random.inDisc()};
    settleHeight(part, heap, candidate);
    if (k == 0 || candidate.height_mm < best.height_mm) best = candidate;
  }
  return best;
}

/// Downhill by small random moves, from large to small: comes to rest where a part would.
Placement nudged(const Part& part,
                 const HeapTop& heap,
                 double limit_mm,
                 const HeapOptions& options,
                 Placement placement,
                 Random& random) {
  constexpr double kLargestTurn = 0.2;   // tangent of half the angle
  constexpr double kLargestShift = 0.1;  // of the limit
  constexpr double kSmallest = 0.02;     // of the largest
  for (int k = 0; k < options.nudges; ++k) {
    const double cooling = 1.0 - static_cast<double>(k) / options.nudges;
    const double scale = kSmallest + (1.0 - kSmallest) * cooling * cooling;
    const glm::dvec2 shift = kLargestShift * scale * limit_mm * random.inDisc();
    Placement candidate = placement;
    candidate.rotation = random.smallRotation(kLargestTurn * scale) * placement.rotation;
    candidate.at_mm += shift;
    if (glm::dot(candidate.at_mm, candidate.at_mm) > limit_mm * limit_mm) continue;
    settleHeight(part, heap, candidate);
    if (candidate.height_mm + options.friction * glm::length(shift) < placement.height_mm) {
      placement = candidate;
    }
  }
  return placement;
}

Pose worldFromObject(const Part& part, const Placement& placement) {
  const glm::dvec3 center(placement.at_mm, placement.height_mm);
  const glm::dmat3 rotation = orthonormalized(placement.rotation);
  return {rotation, center - rotation * part.center_mm};
}

}  // namespace

void HeapOptions::check() const {
  RP_CHECK(count >= 1 && count <= 10000,
           "heap: count is " + std::to_string(count) + ", must be 1 to 10000");
  RP_CHECK(drops >= 1, "heap: drops is " + std::to_string(drops) + ", must be at least 1");
  RP_CHECK(nudges >= 0, "heap: nudges is " + std::to_string(nudges) + ", must not be negative");
  RP_CHECK(cell_mm >= 0.0, "heap: cell_mm must not be negative");
  RP_CHECK(radius_mm >= 0.0, "heap: radius_mm must not be negative");
  RP_CHECK(friction >= 0.0, "heap: friction must not be negative");
}

glm::dvec3 centerOfMass(const Mesh& mesh) {
  double volume = 0.0;
  glm::dvec3 moment(0.0);
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[triangle.x];
    const glm::dvec3 b = mesh.vertices[triangle.y];
    const glm::dvec3 c = mesh.vertices[triangle.z];
    const double six_volumes = glm::dot(a, glm::cross(b, c));
    volume += six_volumes;
    moment += six_volumes * (a + b + c);
  }
  RP_CHECK(volume > 0.0,
           "mesh " + mesh.name + ": no inside; give a closed mesh with faces outwards");
  return moment / (4.0 * volume);
}

std::vector<PlacedPart> makeHeap(const std::vector<Mesh>& meshes, const HeapOptions& options) {
  options.check();
  RP_CHECK(!meshes.empty(), "heap: no mesh given");
  std::vector<Part> parts;
  double largest_mm = 0.0;  // from a centre of mass to anything of its part
  for (const Mesh& mesh : meshes) {
    checkMesh(mesh);
    parts.push_back({mesh, centerOfMass(mesh)});
    const glm::dvec3 center = parts.back().center_mm;
    for (const glm::vec3& vertex : mesh.vertices) {
      largest_mm = std::max(largest_mm, glm::length(glm::dvec3(vertex) - center));
    }
  }
  const double radius_mm = options.radius_mm > 0.0
                               ? options.radius_mm
                               : 0.5 * largest_mm * std::sqrt(static_cast<double>(options.count));
  const double limit_mm = radius_mm + largest_mm;
  const double cell_mm = options.cell_mm > 0.0 ? options.cell_mm : 0.01 * largest_mm;
  HeapTop heap(limit_mm + largest_mm + 4.0 * cell_mm, cell_mm);
  Random random(options.seed);
  std::vector<PlacedPart> placed;
  for (int k = 0; k < options.count; ++k) {
    const int index = k % static_cast<int>(parts.size());
    const Part& part = parts[static_cast<std::size_t>(index)];
    const Placement drop = lowestDrop(part, heap, radius_mm, options.drops, random);
    const Placement rest = nudged(part, heap, limit_mm, options, drop, random);
    heap.add(columnsOf(part.mesh, part.center_mm, rest.rotation, rest.at_mm, cell_mm),
             rest.height_mm);
    placed.push_back({index, worldFromObject(part, rest)});
  }
  return placed;
}

}  // namespace rangepose
