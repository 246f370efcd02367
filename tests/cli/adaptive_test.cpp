// rangepose build --sampling adaptive: from a mesh that nobody has seen before to a database by one
// command.
#include <gmock/gmock.h>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

/// A wedge as an ASCII STL in millimetres.
std::string wedgeStl() {
  const std::vector<std::vector<int>> faces = {{0, 0, 0, 0, 20, 0, 40, 0, 0},
                                               {40, 0, 0, 0, 20, 0, 40, 20, 0},
                                               {0, 0, 0, 0, 0, 12, 0, 20, 0},
                                               {0, 20, 0, 0, 0, 12, 0, 20, 12},
                                               {0, 0, 0, 40, 0, 0, 0, 0, 12},
                                               {0, 20, 0, 0, 20, 12, 40, 20, 0},
                                               {40, 0, 0, 40, 20, 0, 0, 0, 12},
                                               {40, 20, 0, 0, 20, 12, 0, 0, 12}};
  std::string text = "solid wedge\n";
  for (const std::vector<int>& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (std::size_t i = 0; i < 9; i += 3) {
      text += "vertex " + std::to_string(face[i]) + " " + std::to_string(face[i + 1]) + " " +
              std::to_string(face[i + 2]) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid wedge\n";
}

class AdaptiveTest : public CliTest {
 protected:
  void SetUp() override { write("wedge.stl", wedgeStl()); }
  RunResult build(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"build",
                                          "wedge.stl",
                                          "-o",
                                          "wedge.rpdb",
                                          "--views",
                                          "60",
                                          "--size",
                                          "32",
                                          "--path",
                                          "host",
                                          "--sampling",
                                          "adaptive"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(AdaptiveTest, ANewPartIsSimulatedOnceAndKept) {
  const RunResult first = build({"--bins", "1", "--statistics", "pictures"});
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.err, "");
  EXPECT_THAT(first.out, ContainsRegex("1 +wedge +8 .* 60 +[0-9.]+ +none, 1 twin\n"));
  EXPECT_THAT(first.out, ContainsRegex("wedge: [0-9]+ parts in 1 bins, simulated in [0-9]+ s"));
  EXPECT_THAT(
      files(),
      UnorderedElementsAre("wedge.stl", "wedge.rpdb", "wedge.poses", "pictures/wedge_poses.png"));
  const std::string database = readText(folder() / "wedge.rpdb");
  const RunResult second = build({});
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.out, ContainsRegex("wedge: [0-9]+ parts in 1 bins, from wedge.poses"));
  EXPECT_TRUE(readText(folder() / "wedge.rpdb") == database) << "other views from the same file";
}

TEST_F(AdaptiveTest, StatisticsOfAnotherMeshAreNotUsed) {
  ASSERT_EQ(build({"--bins", "1"}).exit_code, 0);
  const std::string stale = readText(folder() / "wedge.poses");
  std::string other = wedgeStl();
  for (std::size_t at = other.find(" 40 "); at != std::string::npos; at = other.find(" 40 ")) {
    other.replace(at, 4, " 50 ");
  }
  write("wedge.stl", other);
  const RunResult result = build({"--bins", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ContainsRegex("^rangepose: warning: wedge.poses: .*another mesh.*\n$"));
  EXPECT_THAT(result.out, HasSubstr("simulated"));
  EXPECT_NE(readText(folder() / "wedge.poses"), stale);
}

TEST_F(AdaptiveTest, ADamagedStatisticsFileIsReplaced) {
  write("wedge.poses", "RPPS but not really");
  const RunResult result = build({"--bins", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ContainsRegex("^rangepose: warning: wedge.poses: .*not used\n$"));
  EXPECT_THAT(result.out, HasSubstr("simulated"));
}

TEST_F(AdaptiveTest, ShippedStatisticsNeedNoSimulation) {
  ASSERT_TRUE(std::filesystem::exists(kModels / "bolt.poses"));
  const RunResult result = run({"build",
                                (kModels / "bolt.ply").string(),
                                "-o",
                                "bolt.rpdb",
                                "--views",
                                "60",
                                "--size",
                                "32",
                                "--path",
                                "host",
                                "--sampling",
                                "adaptive"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("bolt: [0-9]+ parts in [0-9]+ bins, from .*bolt.poses"));
  EXPECT_THAT(result.out, Not(HasSubstr("simulated")));
  EXPECT_THAT(files(), UnorderedElementsAre("bolt.rpdb", "wedge.stl"));
}

TEST_F(AdaptiveTest, OptionsOfTheStatisticsNeedIt) {
  const std::vector<std::string> uniform = {"build", "wedge.stl", "-o", "wedge.rpdb"};
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--bins", "3"}, {"--statistics", "pictures"}}) {
    std::vector<std::string> arguments = uniform;
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_TRUE(failsWith(run(arguments), 2, {"--sampling adaptive"}));
  }
  EXPECT_EQ(build({"--bins", "0"}).exit_code, 2);
}

TEST_F(AdaptiveTest, AFolderForPicturesThatCannotBeIsToldBeforeTheWork) {
  write("pictures", "a file");
  EXPECT_TRUE(failsWith(build({"--bins", "1", "--statistics", "pictures"}), 1, {"pictures"}));
  EXPECT_THAT(files(), UnorderedElementsAre("wedge.stl", "pictures"));
}

}  // namespace
}  // namespace rangepose::test
