#include "io/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"
#include "io/mesh_assimp.h"
#include "io/off_file.h"
#include "io/ply_file.h"

namespace rangepose {
namespace {

constexpr std::uintmax_t kMaxMeshBytes = std::uintmax_t{4} << 30;

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return text;
}

Mesh scaled(const RawMesh& raw, double scale) {
  Mesh mesh;
  mesh.vertices.reserve(raw.vertices.size());
  for (const glm::dvec3& vertex : raw.vertices) mesh.vertices.emplace_back(vertex * scale);
  mesh.triangles = raw.triangles;
  return mesh;
}

/// assimp reads an STL file that was cut short as one with fewer faces: it is recognised here.
void checkStlComplete(const std::filesystem::path& path, const std::string& where) {
  constexpr std::streamoff kHeaderBytes = 84;
  constexpr std::streamoff kFaceBytes = 50;
  constexpr std::streamoff kTailBytes = 400;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  if (size >= kHeaderBytes) {
    std::array<unsigned char, 4> count{};
    file.seekg(kHeaderBytes - 4);
    file.read(reinterpret_cast<char*>(count.data()), 4);
    const std::streamoff faces =
        count[0] | count[1] << 8 | count[2] << 16 | std::streamoff{count[3]} << 24;
    if (size == kHeaderBytes + kFaceBytes * faces) return;
  }
  std::string tail(static_cast<std::size_t>(std::min(size, kTailBytes)), '\0');
  file.seekg(size - static_cast<std::streamoff>(tail.size()));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (file && lowerCase(tail).find("endsolid") != std::string::npos) return;
  throw Error(where +
              ": the STL is truncated or of another type (neither the size of a binary STL nor "
              "an endsolid); export it again");
}

/// PLY and OFF have readers of their own: assimp does not return from some truncated PLY files, and
/// replaces bad indices of OFF.
Mesh readAnyMesh(const std::filesystem::path& path, double scale, const std::string& where) {
  const std::string extension = lowerCase(path.extension().string());
  checkReadableFile(path, "mesh", kMaxMeshBytes);
  if (extension == ".ply") {
    return scaled(parsePlyMesh(readFileBytes(path, "mesh", kMaxMeshBytes), where), scale);
  }
  if (extension == ".off") {
    return scaled(parseOffMesh(readFileBytes(path, "mesh", kMaxMeshBytes), where), scale);
  }
  if (extension == ".stl") checkStlComplete(path, where);
  return importScene(path, scale, where);
}

/// Equal positions become one vertex, in the order of their first appearance.
class VertexJoiner {
 public:
  explicit VertexJoiner(const std::vector<glm::vec3>& vertices)
      : vertices_(vertices), slots_(std::bit_ceil(2 * vertices.size() + 1), kEmpty) {}

  Mesh join(const Mesh& mesh) {
    Mesh joined;
    std::vector<unsigned> new_index(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      unsigned& slot = slotOf(vertices_[i], joined.vertices);
      if (slot == kEmpty) {
        slot = static_cast<unsigned>(joined.vertices.size());
        joined.vertices.push_back(vertices_[i]);
      }
      new_index[i] = slot;
    }
    joined.triangles.reserve(mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
      joined.triangles.emplace_back(new_index[t.x], new_index[t.y], new_index[t.z]);
    }
    return joined;
  }

 private:
  static constexpr unsigned kEmpty = std::numeric_limits<unsigned>::max();

  static std::uint64_t hash(const glm::vec3& v) {
    std::uint64_t value = 0;
    for (int axis = 0; axis < 3; ++axis) {
      value ^= std::bit_cast<std::uint32_t>(v[axis] + 0.0f);  // -0 and 0 are equal
      value *= 0x9e3779b97f4a7c15u;
      value ^= value >> 29;
    }
    return value;
  }

  unsigned& slotOf(const glm::vec3& vertex, const std::vector<glm::vec3>& joined) {
    std::size_t index = static_cast<std::size_t>(hash(vertex)) & (slots_.size() - 1);
    while (slots_[index] != kEmpty && joined[slots_[index]] != vertex) {
      index = (index + 1) & (slots_.size() - 1);
    }
    return slots_[index];
  }

  const std::vector<glm::vec3>& vertices_;
  std::vector<unsigned> slots_;  ///< open addressing; indices into the joined vertices
};

void appendLittleEndian(std::string& bytes, std::uint32_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<char>(value >> shift & 0xffu));
  }
}

void appendVertex(std::string& bytes, const glm::vec3& vertex) {
  for (int axis = 0; axis < 3; ++axis) {
    appendLittleEndian(bytes, std::bit_cast<std::uint32_t>(vertex[axis]));
  }
}

void appendTriangle(std::string& bytes, const glm::uvec3& triangle) {
  for (int corner = 0; corner < 3; ++corner) appendLittleEndian(bytes, triangle[corner]);
}

std::uint64_t fnv1a(std::uint64_t hash, const std::string& bytes) {
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 0x100000001b3u;
  }
  return hash;
}

}  // namespace

void checkFaceCount(std::size_t faces, const std::string& where) {
  if (faces <= kMaxMeshFaces) return;
  throw Error(fmt::format("{}: more than {} faces; simplify the mesh", where, kMaxMeshFaces));
}

Mesh readMesh(const std::filesystem::path& path, LengthUnit unit) {
  const std::string where = fileLabel("mesh", path);
  Mesh mesh = readAnyMesh(path, millimetresPer(unit), where);
  mesh.name = path.string();  // what checkMesh calls it
  checkMesh(mesh);
  mesh = cleaned(VertexJoiner(mesh.vertices).join(mesh));
  mesh.name = path.stem().string();
  return mesh;
}

void writePly(const std::filesystem::path& path, const Mesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment unit mm\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(),
      mesh.triangles.size());
  bytes.reserve(bytes.size() + 12 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const glm::vec3& vertex : mesh.vertices) appendVertex(bytes, vertex);
  for (const glm::uvec3& triangle : mesh.triangles) {
    bytes.push_back(3);
    appendTriangle(bytes, triangle);
  }
  writeFileAtomically(path, bytes);
}

std::uint64_t meshHash(const Mesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  std::string bytes;
  appendLittleEndian(bytes, static_cast<std::uint32_t>(mesh.vertices.size()));
  appendLittleEndian(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  hash = fnv1a(hash, bytes);
  for (const glm::vec3& vertex : mesh.vertices) {
    bytes.clear();
    appendVertex(bytes, vertex);
    hash = fnv1a(hash, bytes);
  }
  for (const glm::uvec3& triangle : mesh.triangles) {
    bytes.clear();
    appendTriangle(bytes, triangle);
    hash = fnv1a(hash, bytes);
  }
  return hash;
}

}  // namespace rangepose
