#include "sim/bin_shape.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace rangepose {
namespace {

/// Corners of a rectangle about the z axis, counterclockwise seen from above.
std::array<unsigned, 4> addRing(Mesh& mesh, double half_x, double half_y, double z) {
  std::array<unsigned, 4> ring{};
  constexpr double kSigns[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    ring[k] = static_cast<unsigned>(mesh.vertices.size());
    mesh.vertices.emplace_back(kSigns[k][0] * half_x, kSigns[k][1] * half_y, z);
  }
  return ring;
}

void addQuad(Mesh& mesh, unsigned a, unsigned b, unsigned c, unsigned d) {
  mesh.triangles.emplace_back(a, b, c);
  mesh.triangles.emplace_back(a, c, d);
}

/// The band between two rings, facing away from the axis when the first is the lower one.
void addBand(Mesh& mesh,
             const std::array<unsigned, 4>& first,
             const std::array<unsigned, 4>& second) {
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    addQuad(mesh, first[k], first[next], second[next], second[k]);
  }
}

}  // namespace

double binThickness(const BinShape& bin) {
  return std::max(1.0, 0.01 * std::max(bin.inner_mm.x, bin.inner_mm.y));
}

Mesh binMesh(const BinShape& bin) {
  const glm::dvec3& inner = bin.inner_mm;
  RP_CHECK(inner.x > 0.0 && inner.y > 0.0 && inner.z > 0.0, "bin: a side is not positive");
  const double wall = binThickness(bin);
  const glm::dvec2 half = 0.5 * glm::dvec2(inner);
  Mesh mesh;
  mesh.name = "bin";
  const auto outer_low = addRing(mesh, half.x + wall, half.y + wall, -wall);
  const auto outer_high = addRing(mesh, half.x + wall, half.y + wall, inner.z);
  const auto inner_high = addRing(mesh, half.x, half.y, inner.z);
  const auto inner_low = addRing(mesh, half.x, half.y, 0.0);
  addBand(mesh, outer_low, outer_high);
  addBand(mesh, outer_high, inner_high);
  addBand(mesh, inner_high, inner_low);
  addQuad(mesh, inner_low[0], inner_low[1], inner_low[2], inner_low[3]);
  addQuad(mesh, outer_low[3], outer_low[2], outer_low[1], outer_low[0]);
  return mesh;
}

}  // namespace rangepose
