// Mesh files that must be refused, by one line and without a word on stdout or stderr.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/io_support.h"
#include "io/mesh_file.h"
#include "io/mesh_samples.h"

namespace rangepose {
namespace {

using test::asciiStl;
using test::binaryStl;
using test::bytesOf;
using test::errorOf;
using test::expectDamageSurvived;
using test::expectTruncationsRefused;
using test::kObj;
using test::kOff;
using test::kPlyFaces;
using test::kPlyHeader;
using test::kPlyVertices;
using test::TempFolder;
using test::tetrahedron;
using testing::AllOf;
using testing::HasSubstr;

void readIt(const std::filesystem::path& path) { readMesh(path, LengthUnit::kMillimetre); }

std::string errorFor(const std::string& name, const std::string& text) {
  const TempFolder folder;
  return errorOf([&] { readIt(folder.write(name, text)); });
}

TEST(MeshDamage, MissingEmptyFolderAndWrongType) {
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

TEST(MeshDamage, PointCloudsHaveNoFaces) {
  std::string header = kPlyHeader;
  EXPECT_THAT(errorFor("c.ply", header.replace(header.find("face 4"), 6, "face 0") + kPlyVertices),
              AllOf(HasSubstr("c.ply"), HasSubstr("no faces")));
  const std::string no_face_element =
      header.substr(0, header.find("element face")) + "end_header\n" + kPlyVertices;
  EXPECT_THAT(errorFor("c.ply", no_face_element), HasSubstr("no faces"));
  EXPECT_NE(errorFor("c.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\n"), "");
  EXPECT_NE(errorFor("c.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), "");
}

TEST(MeshDamage, BadIndicesAreErrors) {
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

TEST(MeshDamage, VerticesThatAreNotFiniteAndFlatMeshesAreErrors) {
  EXPECT_THAT(
      errorFor("n.ply", std::string(kPlyHeader) + "0 0 0\nnan 0 0\n0 2 0\n0 0 3\n" + kPlyFaces),
      AllOf(HasSubstr("n.ply"), HasSubstr("vertex 1 is not finite")));
  EXPECT_THAT(
      errorFor("n.ply", std::string(kPlyHeader) + "0 0 0\n1 0 0\n2 0 0\n3 0 0\n" + kPlyFaces),
      HasSubstr("no face has an area"));
}

TEST(MeshDamage, AbsurdCountsAreRefusedBeforeMemoryIsTaken) {
  std::string text = std::string(kPlyHeader) + kPlyVertices + kPlyFaces;
  text.replace(text.find("vertex 4"), 8, "vertex 4000000000000");
  EXPECT_THAT(errorFor("h.ply", text), HasSubstr("truncated"));
  EXPECT_THAT(errorOf([] { checkFaceCount(kMaxMeshFaces + 1, "mesh m.stl"); }),
              AllOf(HasSubstr("mesh m.stl"), HasSubstr("20000000 faces")));
  EXPECT_NO_THROW(checkFaceCount(kMaxMeshFaces, "mesh m.stl"));
}

TEST(MeshDamage, BrokenPlyHeadersAreErrors) {
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

TEST(MeshDamage, TruncatedFilesAreErrors) {
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

TEST(MeshDamage, ChangedBytesNeverCrash) {
  const TempFolder folder;
  writePly(folder.path() / "whole.ply", tetrahedron());
  expectDamageSurvived("part.ply", bytesOf(folder.path() / "whole.ply"), readIt);
  expectDamageSurvived("part.ply", std::string(kPlyHeader) + kPlyVertices + kPlyFaces, readIt);
  expectDamageSurvived("part.off", kOff, readIt);
  expectDamageSurvived("part.stl", binaryStl(tetrahedron()), readIt);
  expectDamageSurvived("part.stl", asciiStl(tetrahedron()), readIt);
  expectDamageSurvived("part.obj", kObj, readIt);
}

}  // namespace
}  // namespace rangepose
