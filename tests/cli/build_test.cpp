#include <gmock/gmock.h>

#include <ostream>
#include <regex>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class BuildTest : public CliTest {
 protected:
  RunResult build(const std::string& model, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {
        "build", model, "-o", "out.rpdb", "--views", "60", "--size", "32", "--path", "host"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  std::string bolt() const { return (kModels / "bolt.ply").string(); }
  /// A data set whose only model is the bolt.
  void makeBopSet() const {
    std::filesystem::create_directories(folder() / "set/models");
    std::filesystem::copy_file(bolt(), folder() / "set/models/obj_000007.ply");
  }
  RunResult buildBopSet() const {
    return run({"build",
                "--bop",
                "set",
                "-o",
                "out.rpdb",
                "--views",
                "20",
                "--size",
                "32",
                "--path",
                "host"});
  }
};

TEST_F(BuildTest, WritesOneFileAndDescribesEachObject) {
  const RunResult result = run({"build",
                                bolt(),
                                (kModels / "elbow.ply").string(),
                                "-o",
                                "out.rpdb",
                                "--views",
                                "60",
                                "--size",
                                "32"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(files(), ElementsAre("out.rpdb"));
  EXPECT_THAT(result.out, HasSubstr("rendering by host"));
  EXPECT_THAT(result.out, ContainsRegex("1 +bolt +[0-9]+ +[0-9.]+ +[0-9.]+ +60 +[0-9.]+ +C6\n"));
  EXPECT_THAT(result.out, ContainsRegex("2 +elbow +[0-9]+ +114.28 +[0-9.]+ +60 +[0-9.]+ +C2\n"));
  EXPECT_THAT(result.out, ContainsRegex("elbow: [0-9]+ of 7680 triangles are enough"));
  EXPECT_THAT(result.out, ContainsRegex("out.rpdb: [0-9.]+ MB, 2 objects, [0-9.]+ s"));
  EXPECT_EQ(result.err, "");
}

TEST_F(BuildTest, AllTrianglesMayBeKept) {
  const RunResult result = build(bolt(), {"--simplify", "0"});
  EXPECT_THAT(result.out, ContainsRegex("1 +bolt +8252 "));
  EXPECT_THAT(result.out, Not(HasSubstr("are enough")));
  EXPECT_EQ(build(bolt(), {"--simplify", "0.5"}).exit_code, 2) << "half of a part is no part";
}

// A database from another machine would find other poses, where several are about as likely.
TEST_F(BuildTest, TheDatabaseDoesNotDependOnWhatTheMachineCanDraw) {
  const std::vector<std::string> arguments = {
      "build", bolt(), "-o", "out.rpdb", "--views", "20", "--size", "32"};
  ASSERT_EQ(run(arguments, kNoEgl).exit_code, 0);
  const std::string without = readText(folder() / "out.rpdb");
  const RunResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(without.empty());
  EXPECT_TRUE(without == readText(folder() / "out.rpdb"));
}

TEST_F(BuildTest, SameInputGivesSameBytesWithAnyNumberOfThreads) {
  ASSERT_EQ(build(bolt()).exit_code, 0);
  const std::string once = readText(folder() / "out.rpdb");
  ASSERT_EQ(build(bolt(), {"--threads", "1"}).exit_code, 0);
  EXPECT_FALSE(once.empty());
  EXPECT_TRUE(once == readText(folder() / "out.rpdb"));
}

TEST_F(BuildTest, UnitScalesAndStrangeSizesAreWarnedOf) {
  EXPECT_EQ(build(bolt()).err, "");
  const RunResult metres = build(bolt(), {"--unit", "m"});
  EXPECT_EQ(metres.exit_code, 0);
  EXPECT_THAT(metres.err,
              ContainsRegex("^rangepose: warning: object bolt is 62584.* unit .*--unit m\n$"));
}

TEST_F(BuildTest, BopModelsKeepTheirIds) {
  makeBopSet();
  const RunResult result = buildBopSet();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex(" 7  obj_000007 .* C6\n"));
}

TEST_F(BuildTest, SymmetriesOfModelsInfoComeFirst) {
  makeBopSet();
  write("set/models/models_info.json",
        R"({"7": {"diameter": 62.6,
                  "symmetries_discrete": [[-1,0,0,0, 0,-1,0,0, 0,0,1,0, 0,0,0,1]]}})");
  const RunResult result = buildBopSet();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex(" 7  obj_000007 .* C2, 2 twins \\(models_info.json\\)\n"));
}

TEST_F(BuildTest, SymmetriesThatModelsInfoForgetsAreNamed) {
  makeBopSet();
  write("set/models/models_info.json", R"({"7": {"diameter": 62.6}})");
  const RunResult result = buildBopSet();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(
      result.err,
      ContainsRegex("^rangepose: warning: [^\n]*models_info.json names no symmetry, but the "
                    "mesh has C6[^\n]*\n$"))
      << "poses that are as good as each other would share their score, and none be reported";
}

TEST_F(BuildTest, OldDatabaseSurvivesAFailure) {
  write("out.rpdb", "precious");
  const std::string bad = write("bad.ply", "ply\nformat ascii 1.0\nend_header\n").string();
  EXPECT_EQ(build(bad).exit_code, 1);
  EXPECT_EQ(readText(folder() / "out.rpdb"), "precious");
}

TEST_F(BuildTest, MissingFolderOfTheOutputFailsBeforeTheWork) {
  const RunResult result = run({"build", bolt(), "-o", "nowhere/out.rpdb"});
  EXPECT_TRUE(failsWith(result, 1, {"nowhere/out.rpdb", "folder"}));
  EXPECT_TRUE(files().empty());
}

TEST_F(BuildTest, FolderAsOutputIsRefused) {
  EXPECT_TRUE(failsWith(run({"build", bolt(), "-o", folder().string()}), 1, {"folder"}));
}

TEST_F(BuildTest, PathsThatAreNotHereAreExitCodeThree) {
  const std::vector<std::string> arguments = {"build", bolt(), "-o", "out.rpdb", "--path"};
  std::vector<std::string> cuda = arguments;
  cuda.emplace_back("cuda");
  if (!cudaWorks()) {
    EXPECT_TRUE(failsWith(run(cuda), 3, {"cuda"}));
  }
  std::vector<std::string> glsl = arguments;
  glsl.emplace_back("glsl");
  EXPECT_TRUE(failsWith(run(glsl, kNoEgl), 3, {"OpenGL ES", "install"}));
  EXPECT_TRUE(files().empty());
}

struct BadMesh {
  std::string name;
  std::string file;
  std::string bytes;
  std::string said;  ///< regular expression
};

void PrintTo(const BadMesh& mesh, std::ostream* out) { *out << mesh.name; }

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n";
const std::string kVertices = "0 0 0\n50 0 0\n0 50 0\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

const BadMesh kBadMeshes[] = {
    {"Empty", "m.ply", "", "empty"},
    {"WrongType", "m.ply", "this is not a mesh at all\n", "m.ply"},
    {"WithoutFaces", "m.ply", kHeader + "end_header\n" + kVertices, "face|triangle"},
    {"BadIndex", "m.ply", kHeader + kFace + kVertices + "3 0 1 99\n", "99|index"},
    {"Truncated", "m.ply", kHeader + kFace + "0 0 0\n50 0", "m.ply"},
    {"WithoutArea", "m.ply", kHeader + kFace + kVertices + "3 0 1 1\n", "m.ply|area|triangle"},
    {"UnknownFormat", "m.xyz", "1 2 3\n", "m.xyz"},
};

class BadMeshTest : public CliTest, public ::testing::WithParamInterface<BadMesh> {};

TEST_P(BadMeshTest, IsOneLineAndLeavesNothing) {
  write(GetParam().file, GetParam().bytes);
  const RunResult result = run({"build", GetParam().file, "-o", "out.rpdb", "--path", "host"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(std::regex_search(result.err,
                                std::regex("^rangepose: [^\n]*(" + GetParam().said + ")[^\n]*\n$")))
      << result.err;
  EXPECT_THAT(files(), ElementsAre(GetParam().file));
}

INSTANTIATE_TEST_SUITE_P(All, BadMeshTest, ::testing::ValuesIn(kBadMeshes), [](const auto& bad) {
  return bad.param.name;
});

TEST_F(BuildTest, MissingMesh) {
  const RunResult result = build("nothing.stl");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, ContainsRegex("^rangepose: .*nothing.stl.*\n$"));
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace rangepose::test
