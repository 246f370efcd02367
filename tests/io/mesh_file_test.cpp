#include "io/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/error.h"
#include "io/io_support.h"

namespace rangepose {
namespace {

using test::bytesOf;
using test::errorOf;
using test::expectDamageSurvived;
using test::expectTruncationsRefused;
using test::rawBytes;
using test::TempFolder;
using testing::AllOf;
using testing::HasSubstr;

void readIt(const std::filesystem::path& path) { readMesh(path, LengthUnit::kMillimetre); }

Mesh readText(const std::string& name,
              const std::string& text,
              LengthUnit unit = LengthUnit::kMillimetre) {
  const TempFolder folder;
  return readMesh(folder.write(name, text), unit);
}

std::string errorFor(const std::string& name, const std::string& text) {
  return errorOf([&] { readText(name, text); });
}

/// A tetrahedron with right angles at the origin and legs of 1, 2 and 3.
Mesh tetrahedron() {
  Mesh mesh;
  mesh.name = "part";
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
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

const char* const kObj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const char* const kOff =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const char* const kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const char* const kPlyVertices = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n";
const char* const kPlyFaces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

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
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 3]},
        {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48}],
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
  const auto path = folder.write(
      "part.gltf",
      gltf(
          R"([{"mesh": 0, "translation": [10, 0, 0]}, {"scale": [2, 2, 2], "children": [2]}, {"mesh": 0}])"));
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

TEST(MeshFile, MissingEmptyFolderAndWrongType) {
  const TempFolder folder;
  EXPECT_THAT(errorOf([&] { readIt(folder.path() / "none.stl"); }),
              AllOf(HasSubstr("none.stl"), HasSubstr("no such file")));
  EXPECT_THAT(errorOf([&] { readIt(folder.path()); }), HasSubstr("not a regular file"));
  for (const char* name : {"e.stl", "e.obj", "e.ply", "e.glb"}) {
    EXPECT_THAT(errorFor(name, ""), HasSubstr("the file is empty"));
    EXPECT_THAT(errorFor(name, "\x89PNG\r\n\x1a\n not a mesh at all, of any kind; just some bytes"),
                HasSubstr(name));
  }
  EXPECT_THAT(errorFor("scan.png", "\x89PNG\r\n\x1a\n"), HasSubstr("not a readable mesh"));
  EXPECT_THAT(errorFor("part.ply", kObj), HasSubstr("not a PLY file"));
}

TEST(MeshFile, PointCloudsHaveNoFaces) {
  std::string header = kPlyHeader;
  EXPECT_THAT(errorFor("c.ply", header.replace(header.find("face 4"), 6, "face 0") + kPlyVertices),
              AllOf(HasSubstr("c.ply"), HasSubstr("no faces")));
  const std::string no_face_element =
      header.substr(0, header.find("element face")) + "end_header\n" + kPlyVertices;
  EXPECT_THAT(errorFor("c.ply", no_face_element), HasSubstr("no faces"));
  EXPECT_NE(errorFor("c.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\n"), "");
  EXPECT_NE(errorFor("c.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), "");
}

TEST(MeshFile, BadIndicesAreErrors) {
  const std::string start = std::string(kPlyHeader) + kPlyVertices + "3 0 2 1\n3 0 1 3\n3 0 3 2\n";
  EXPECT_THAT(errorFor("b.ply", start + "3 1 2 4\n"),
              AllOf(HasSubstr("b.ply"), HasSubstr("face 3 names vertex 4")));
  EXPECT_THAT(errorFor("b.ply", start + "3 1 2 -1\n"), HasSubstr("names vertex -1"));
  EXPECT_NE(errorFor("b.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 9\n"), "");
  EXPECT_THAT(errorFor("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
              HasSubstr("face 0 names vertex 7"));
  EXPECT_THAT(errorFor("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n"),
              HasSubstr("names vertex nan"));
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

TEST(MeshFile, VerticesThatAreNotFiniteAndFlatMeshesAreErrors) {
  EXPECT_THAT(
      errorFor("n.ply", std::string(kPlyHeader) + "0 0 0\nnan 0 0\n0 2 0\n0 0 3\n" + kPlyFaces),
      AllOf(HasSubstr("n.ply"), HasSubstr("vertex 1 is not finite")));
  EXPECT_THAT(
      errorFor("n.ply", std::string(kPlyHeader) + "0 0 0\n1 0 0\n2 0 0\n3 0 0\n" + kPlyFaces),
      HasSubstr("no face has an area"));
}

TEST(MeshFile, AbsurdCountsAreRefusedBeforeMemoryIsTaken) {
  std::string text = std::string(kPlyHeader) + kPlyVertices + kPlyFaces;
  text.replace(text.find("vertex 4"), 8, "vertex 4000000000000");
  EXPECT_THAT(errorFor("h.ply", text), HasSubstr("truncated"));
  EXPECT_THAT(errorOf([] { checkFaceCount(kMaxMeshFaces + 1, "mesh m.stl"); }),
              AllOf(HasSubstr("mesh m.stl"), HasSubstr("20000000 faces")));
  EXPECT_NO_THROW(checkFaceCount(kMaxMeshFaces, "mesh m.stl"));
}

TEST(MeshFile, BrokenPlyHeadersAreErrors) {
  const std::string body = std::string(kPlyVertices) + kPlyFaces;
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string text = kPlyHeader;
    return errorFor("h.ply", text.replace(text.find(from), from.size(), to) + body);
  };
  EXPECT_THAT(error("ascii", "text"), HasSubstr("not understood"));
  EXPECT_THAT(error("format ascii 1.0\n", ""), HasSubstr("no format"));
  EXPECT_THAT(error("float y", "colour y"), HasSubstr("not understood"));
  EXPECT_THAT(error("float y", "float up"), HasSubstr("no number y"));
  EXPECT_THAT(error("vertex 4", "vertex -4"), HasSubstr("not understood"));
  EXPECT_THAT(error("uchar int", "float int"), HasSubstr("not understood"));
  EXPECT_THAT(error("vertex_indices", "corners"), HasSubstr("no list vertex_indices"));
  EXPECT_THAT(error("element vertex", "element point"), HasSubstr("no element vertex"));
  EXPECT_THAT(error("end_header\n", ""), HasSubstr("PLY header"));
}

TEST(MeshFile, TruncatedFilesAreErrors) {
  const Mesh mesh = tetrahedron();
  const TempFolder folder;
  writePly(folder.path() / "whole.ply", mesh);
  const std::string binary_ply = bytesOf(folder.path() / "whole.ply");
  expectTruncationsRefused("part.ply", binary_ply, binary_ply.size(), readIt);
  // The last digit of an ASCII file may be followed by nothing.
  const std::string ply = std::string(kPlyHeader) + kPlyVertices + kPlyFaces;
  expectTruncationsRefused("part.ply", ply, ply.size() - 1, readIt);
  const std::string stl = binaryStl(mesh);
  expectTruncationsRefused("part.stl", stl, stl.size(), readIt);
  const std::string text_stl = asciiStl(mesh);
  expectTruncationsRefused("part.stl", text_stl, text_stl.find("endsolid") + 8, readIt);
  const std::string off = kOff;
  expectTruncationsRefused("part.off", off, off.size() - 1, readIt);
  // OBJ is readable once it has a face.
  const std::string obj = kObj;
  expectTruncationsRefused("part.obj", obj, obj.find("f 1 3 2"), readIt);
}

TEST(MeshFile, ChangedBytesNeverCrash) {
  const TempFolder folder;
  writePly(folder.path() / "whole.ply", tetrahedron());
  expectDamageSurvived("part.ply", bytesOf(folder.path() / "whole.ply"), readIt);
  expectDamageSurvived("part.ply", std::string(kPlyHeader) + kPlyVertices + kPlyFaces, readIt);
  expectDamageSurvived("part.off", kOff, readIt);
  expectDamageSurvived("part.stl", binaryStl(tetrahedron()), readIt);
  expectDamageSurvived("part.stl", asciiStl(tetrahedron()), readIt);
  expectDamageSurvived("part.obj", kObj, readIt);
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
