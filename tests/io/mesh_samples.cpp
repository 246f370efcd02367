#include "io/mesh_samples.h"

#include <cstdint>

#include "io/io_support.h"

namespace rangepose::test {

Mesh tetrahedron() {
  Mesh mesh;
  mesh.name = "part";
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

std::string binaryStl(const Mesh& mesh) {
  std::string bytes = "solid misleading name";
  bytes.resize(80, ' ');
  bytes += rawBytes(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const glm::uvec3& t : mesh.triangles) {
    bytes += std::string(12, '\0');
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) bytes += rawBytes(mesh.vertices[t[corner]][axis]);
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string asciiStl(const Mesh& mesh) {
  std::string text = "solid part\n";
  for (const glm::uvec3& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 v = mesh.vertices[t[corner]];
      text += "vertex " + std::to_string(v.x) + " " + std::to_string(v.y) + " " +
              std::to_string(v.z) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

}  // namespace rangepose::test
