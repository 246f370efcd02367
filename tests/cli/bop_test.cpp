#include <gmock/gmock.h>

#include <chrono>
#include <sstream>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// A data set with two images: the demo, and one that cannot be read if `damaged`.
class BopRunTest : public CliTest {
 protected:
  void makeDataset(bool damaged) const {
    fs::create_directories(folder() / "set/test/000003/depth");
    for (const char* image : {"000000.png", "000012.png"}) {
      fs::copy_file(kModels / "demo/depth.png", folder() / "set/test/000003/depth" / image);
    }
    if (damaged) write("set/test/000003/depth/000012.png", "no picture");
    const std::string camera = R"({"cam_K": [570,0,319.5,0,570,239.5,0,0,1], "depth_scale": 0.1})";
    write("set/test/000003/scene_camera.json", R"({"0": )" + camera + R"(, "12": )" + camera + "}");
  }
  RunResult runSet() const {
    return run({"estimate",
                "--db",
                elbowDatabase(),
                "--bop",
                "set",
                "--csv",
                "r.csv",
                "--max-poses",
                "3"});
  }
  std::vector<std::string> rows() const {
    std::vector<std::string> lines;
    std::istringstream text(readText(folder() / "r.csv"));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
};

int rowsOf(const std::vector<std::string>& rows, const std::string& prefix) {
  int count = 0;
  for (const std::string& row : rows) count += row.rfind(prefix, 0) == 0 ? 1 : 0;
  return count;
}

TEST_F(BopRunTest, WritesTheRowsOfAllImages) {
  makeDataset(false);
  const auto begin = std::chrono::steady_clock::now();
  const RunResult result = runSet();
  const std::chrono::duration<double> took_s = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("2 of 2 images"));
  EXPECT_EQ(result.err, "");
  const std::vector<std::string> all = rows();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front(), "scene_id,im_id,obj_id,score,R,t,time");
  EXPECT_GE(rowsOf(all, "3,0,1,"), 3);
  EXPECT_EQ(rowsOf(all, "3,0,1,"), rowsOf(all, "3,12,1,"));
  std::set<std::string> times;
  for (const std::string& row : all) {
    if (row.rfind("3,0,", 0) == 0) times.insert(row.substr(row.rfind(',') + 1));
  }
  ASSERT_EQ(times.size(), 1U) << "one time an image";
  EXPECT_GT(std::stod(*times.begin()), 0.0);
  EXPECT_LT(std::stod(*times.begin()), took_s.count()) << "of an image, in seconds";
}

TEST_F(BopRunTest, AnUnreadableImageIsNamedAndTheOthersAreWritten) {
  makeDataset(true);
  const RunResult result = runSet();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, ContainsRegex("^rangepose: scene 3 image 12: .*000012.png.*\n$"));
  EXPECT_THAT(result.out, HasSubstr("1 of 2 images"));
  EXPECT_GE(rowsOf(rows(), "3,0,1,"), 3);
  EXPECT_EQ(rowsOf(rows(), "3,12,"), 0);
}

TEST_F(BopRunTest, BinOfTheSceneIsUsed) {
  makeDataset(false);
  // Image 12 looks at a bin far beside the heap.
  write("set/test/000003/scene_bin.json",
        R"({"12": {"cam_R_bin2c": [1,0,0,0,-1,0,0,0,-1], "cam_t_bin2c": [2000,0,700],
 "inner_size": [100,100,100]}})");
  EXPECT_EQ(runSet().exit_code, 0);
  EXPECT_GE(rowsOf(rows(), "3,0,1,"), 3);
  EXPECT_EQ(rowsOf(rows(), "3,12,"), 0);
}

TEST_F(BopRunTest, SplitThatIsNotThere) {
  makeDataset(false);
  fs::create_directories(folder() / "set/models");
  fs::copy_file(kModels / "elbow.ply", folder() / "set/models/obj_000001.ply");
  const RunResult result = run(
      {"estimate", "--db", smallDatabase(), "--bop", "set", "--split", "val", "--csv", "r.csv"});
  EXPECT_TRUE(failsWith(result, 1, {"val"}));
  EXPECT_FALSE(fs::exists(folder() / "r.csv"));
}

TEST_F(BopRunTest, NoDataSet) {
  const RunResult result =
      run({"estimate", "--db", smallDatabase(), "--bop", "nothing", "--csv", "r.csv"});
  EXPECT_TRUE(failsWith(result, 1, {"nothing"}));
  EXPECT_FALSE(fs::exists(folder() / "r.csv"));
}

}  // namespace
}  // namespace rangepose::test
