#include "io/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/error.h"
#include "io/io_support.h"
#include "io/mesh_samples.h"

namespace rangepose {
namespace {

using test::asciiStl;
using test::binaryStl;
using test::bytesOf;
using test::errorOf;
using test::kObj;
using test::kOff;
using test::kPlyFaces;
using test::kPlyHeader;
using test::kPlyVertices;
using test::rawBytes;
using test::TempFolder;
using test::tetrahedron;
using testing::AllOf;
using testing::HasSubstr;

Mesh readText(const std::string& name,
              const std::string& text,
              LengthUnit unit = LengthUnit::kMillimetre) {
  const TempFolder folder;
  return readMesh(folder.write(name, text), unit);
}

std::string errorFor(const std::string& name, const std::string& text) {
  return errorOf([&] { readText(name, text); });
}

double signedVolume(const Mesh& mesh) {
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[t.x];
    const glm::dvec3 b = mesh.vertices[t.y];
    const glm::dvec3 c = mesh.vertices[t.z];
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

void expectTetrahedron(const Mesh& mesh, double scale) {
  EXPECT_EQ(mesh.name, "part");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(signedVolume(mesh), scale * scale * scale, 1e-5 * scale * scale * scale);
}

TEST(LengthUnit, Parses) {
  EXPECT_EQ(millimetresPer(parseLengthUnit("mm")), 1.0);
  EXPECT_EQ(millimetresPer(parseLengthUnit("m")), 1000.0);
  EXPECT_EQ(millimetresPer(parseLengthUnit("inch")), 25.4);
  EXPECT_THAT(errorOf([] { parseLengthUnit("cm\n"); }), HasSubstr("use mm, m or inch"));
}

TEST(MeshFile, ReadsEachFormatWithVerticesJoined) {
  const std::string ply = std::string(kPlyHeader) + kPlyVertices + kPlyFaces;
  expectTetrahedron(readText("part.stl", binaryStl(tetrahedron())), 1.0);
  expectTetrahedron(readText("part.STL", asciiStl(tetrahedron())), 1.0);
  expectTetrahedron(readText("part.obj", kObj), 1.0);
  expectTetrahedron(readText("part.off", kOff), 1.0);
  expectTetrahedron(readText("part.ply", ply), 1.0);
}

TEST(MeshFile, UnitScalesEveryFormat) {
  const std::string ply = std::string(kPlyHeader) + kPlyVertices + kPlyFaces;
  expectTetrahedron(readText("part.stl", binaryStl(tetrahedron()), LengthUnit::kMetre), 1000.0);
  expectTetrahedron(readText("part.obj", kObj, LengthUnit::kInch), 25.4);
  expectTetrahedron(readText("part.ply", ply, LengthUnit::kMetre), 1000.0);
}

/// glTF with the tetrahedron in a buffer beside it, and two nodes that show it.
std::string gltf(const std::string& nodes) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": )" +
         nodes +
         R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
      "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
         "min": [0, 0, 0], "max": [1, 2, 3]},
        {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                      {"buffer": 0, "byteOffset": 48, "byteLength": 48}],
      "buffers": [{"uri": "part.bin", "byteLength": 96}]})";
}

std::string gltfBuffer() {
  std::string bytes;
  const Mesh mesh = tetrahedron();
  for (const glm::vec3& v : mesh.vertices) bytes += rawBytes(v.x) + rawBytes(v.y) + rawBytes(v.z);
  for (const glm::uvec3& t : mesh.triangles) bytes += rawBytes(t.x) + rawBytes(t.y) + rawBytes(t.z);
  return bytes;
}

TEST(MeshFile, JoinsMeshesWithTheTransformsOfTheirNodes) {
  const TempFolder folder;
  folder.write("part.bin", gltfBuffer());
  const auto path = folder.write("part.gltf",
                                 gltf(
                                     R"([{"mesh": 0, "translation": [10, 0, 0]},
                {"scale": [2, 2, 2], "children": [2]}, {"mesh": 0}])"));
  const Mesh mesh = readMesh(path, LengthUnit::kMillimetre);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_NEAR(signedVolume(mesh), 1.0 + 8.0, 1e-5);
  glm::vec3 high{0.0f};
  for (const glm::vec3& v : mesh.vertices) high = glm::max(high, v);
  EXPECT_EQ(high, glm::vec3(11.0f, 4.0f, 6.0f));
}

TEST(MeshFile, MirroringNodeKeepsFacesOutside) {
  const TempFolder folder;
  folder.write("part.bin", gltfBuffer());
  const auto path = folder.write(
      "part.gltf",
      gltf(R"([{"mesh": 0, "scale": [-1, 1, 1]}, {"mesh": 0, "translation": [9, 9, 9]}])"));
  EXPECT_NEAR(signedVolume(readMesh(path, LengthUnit::kMillimetre)), 2.0, 1e-5);
}

TEST(MeshFile, GltfWithoutItsBufferIsAnError) {
  EXPECT_THAT(errorFor("part.gltf", gltf(R"([{"mesh": 0}, {"mesh": 0}])")), HasSubstr("part.gltf"));
}

TEST(MeshFile, FacesWithoutAreaAndLooseVerticesAreRemoved) {
  const Mesh mesh =
      readText("part.obj", std::string(kObj) + "v 9 9 9\nv 0.5 0 0\nf 1 1 2\nf 1 6 2\n");
  expectTetrahedron(mesh, 1.0);
}

TEST(MeshFile, ReadsBinaryPlyOfBothOrdersWithOtherPropertiesAndPolygons) {
  for (const bool big : {false, true}) {
    std::string bytes =
        std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
        " 1.0\r\ncomment made by hand\r\nelement material 1\r\nproperty list ushort char name\r\n"
        "element vertex 5\r\nproperty uchar red\r\nproperty double z\r\nproperty float y\r\n"
        "property short x\r\nelement face 2\r\nproperty float quality\r\n"
        "property list uchar uint vertex_index\r\nend_header\r\n";
    bytes += rawBytes(std::uint16_t{3}, big) + "abc";
    // A square of side 4 at z = 7 that lacks its right quarter (an arrow tail), and a triangle.
    const int corners[5][2] = {{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}};
    for (const auto& c : corners) {
      bytes += std::string("\x55") + rawBytes(7.0, big) + rawBytes(static_cast<float>(c[1]), big) +
               rawBytes(static_cast<std::int16_t>(c[0]), big);
    }
    bytes += rawBytes(0.5f, big) + "\x05";
    for (const unsigned index : {0u, 1u, 2u, 3u, 4u}) bytes += rawBytes(index, big);
    bytes += rawBytes(0.5f, big) + "\x03";
    for (const unsigned index : {1u, 3u, 2u}) bytes += rawBytes(index, big);
    const Mesh mesh = readText("part.ply", bytes);
    EXPECT_EQ(mesh.vertices.size(), 5u);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 a = mesh.vertices[t.x];
      area += glm::length(glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a)) / 2.0;
      EXPECT_EQ(a.z, 7.0f);
    }
    EXPECT_NEAR(area, 16.0, 1e-6);
  }
}

TEST(MeshFile, ReadsOffWithColoursCommentsAndGluedCounts) {
  const Mesh mesh = readText(
      "part.off",
      "COFF4 4 6\n# the corners\n0 0 0 255 0 0\n1 0 0 9 9 9\n\n0 2 0 9 9 9\n0 0 3 9 9 9 9\n"
      "3 0 2 1 0.5 0.5 0.5\n3 0 1 3\n3 0 3 2 # left\n3 1 2 3");
  expectTetrahedron(mesh, 1.0);
  EXPECT_THAT(errorFor("h.off", "OFF\n900000000 1 0\n0 0 0\n"), HasSubstr("truncated"));
  EXPECT_THAT(errorFor("h.off", "OFF\n1 x 0\n0 0 0\n"), HasSubstr("whole number"));
  EXPECT_THAT(errorFor("h.off", "4OFF\n1 1 0\n0 0 0 1\n"), HasSubstr("not an OFF"));
}

TEST(MeshFile, WrittenPlyIsReadBackExactly) {
  const TempFolder folder;
  Mesh mesh = tetrahedron();
  mesh.vertices[1].x = 0.1f;
  writePly(folder.path() / "part.ply", mesh);
  const Mesh read = readMesh(folder.path() / "part.ply", LengthUnit::kMillimetre);
  EXPECT_EQ(meshHash(read), meshHash(cleaned(mesh)));
  EXPECT_EQ(read.name, "part");
}

TEST(MeshHash, IsFnv1aOfTheLittleEndianBytes) {
  Mesh empty;
  // Eight zero bytes, counted by hand: the offset basis times the prime to the eighth.
  std::uint64_t expected = 0xcbf29ce484222325u;
  for (int i = 0; i < 8; ++i) expected *= 0x100000001b3u;
  EXPECT_EQ(meshHash(empty), expected);
}

TEST(MeshHash, ChangesWithEachPartButTheName) {
  const Mesh mesh = tetrahedron();
  Mesh other = mesh;
  other.name = "another";
  EXPECT_EQ(meshHash(other), meshHash(mesh));
  other = mesh;
  other.vertices[3].z = std::nextafter(3.0f, 4.0f);
  EXPECT_NE(meshHash(other), meshHash(mesh));
  other = mesh;
  std::swap(other.triangles[0], other.triangles[1]);
  EXPECT_NE(meshHash(other), meshHash(mesh));
}

}  // namespace
}  // namespace rangepose
