#include "gles/mesh_buffers.h"

#include <array>
#include <bit>
#include <vector>

namespace rangepose::gles {
namespace {

struct Corner {
  glm::vec3 position;
  glm::vec3 normal;
};
static_assert(sizeof(Corner) == 6 * sizeof(float));

std::vector<Corner> cornersOf(const Mesh& mesh, const glm::dvec3& center) {
  std::vector<Corner> corners;
  corners.reserve(mesh.triangles.size() * 3);
  for (const glm::uvec3& triangle : mesh.triangles) {
    const std::array<glm::dvec3, 3> at = {glm::dvec3(mesh.vertices[triangle.x]),
                                          glm::dvec3(mesh.vertices[triangle.y]),
                                          glm::dvec3(mesh.vertices[triangle.z])};
    const glm::dvec3 cross = glm::cross(at[1] - at[0], at[2] - at[0]);
    const double length = glm::length(cross);
    if (length == 0.0) continue;
    for (const glm::dvec3& p : at)
      corners.push_back({glm::vec3(p - center), glm::vec3(cross / length)});
  }
  return corners;
}

Buffer upload(const std::vector<Corner>& corners, int& count) {
  count = static_cast<int>(corners.size());
  return {corners.data(), corners.size() * sizeof(Corner)};
}

/// FNV-1a over the mesh.
std::uint64_t contentHash(const Mesh& mesh) {
  std::uint64_t hash = 14695981039346656037ULL;
  const auto mix = [&hash](std::uint64_t value) { hash = (hash ^ value) * 1099511628211ULL; };
  for (const glm::vec3& v : mesh.vertices) {
    for (int i = 0; i < 3; ++i) mix(std::bit_cast<std::uint32_t>(v[i]));
  }
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) mix(t[i]);
  }
  return hash;
}

}  // namespace

MeshBuffers::MeshBuffers(const Mesh& mesh)
    : sphere_(boundingSphere(mesh)), buffer_(upload(cornersOf(mesh, sphere_.center_mm), corners_)) {
  addTo(vertices_);
}

void MeshBuffers::addTo(VertexArray& vertices) const {
  constexpr int kStride = sizeof(Corner);
  vertices.add(buffer_, {0, 3, false, kStride, offsetof(Corner, position), false});
  vertices.add(buffer_, {1, 3, false, kStride, offsetof(Corner, normal), false});
}

std::shared_ptr<const MeshBuffers> ResidentMeshes::of(const Mesh& mesh) {
  return meshes_.of(contentHash(mesh), [&] { return MeshBuffers(mesh); });
}

}  // namespace rangepose::gles
