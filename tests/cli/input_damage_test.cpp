// Bad input of every kind: exit code 1, one line that names it, and nothing left behind.
#include <gmock/gmock.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

class InputDamageTest : public CliTest {
 protected:
  InputDamageTest() : database_(smallDatabase()) {}

  /// Estimates with JSON and overlay asked for; neither may be there after a failure.
  ::testing::AssertionResult refused(const std::vector<std::string>& scene,
                                     const std::vector<std::string>& words) const {
    std::vector<std::string> arguments = {
        "estimate", "--db", database_, "--json", "o.json", "--overlay", "o.png"};
    arguments.insert(arguments.end(), scene.begin(), scene.end());
    const std::set<std::string> before = files();
    const ::testing::AssertionResult failed = failsWith(run(arguments), 1, words);
    if (!failed) return failed;
    if (files() != before) return ::testing::AssertionFailure() << "files were left behind";
    return ::testing::AssertionSuccess();
  }
  ::testing::AssertionResult depthRefused(const std::string& depth,
                                          const std::vector<std::string>& words) const {
    return refused({"--depth", depth, "--camera", kCamera}, words);
  }
  ::testing::AssertionResult databaseRefused(const std::string& bytes,
                                             const std::vector<std::string>& words) {
    database_ = write("bad.rpdb", bytes).filename().string();
    std::vector<std::string> all = words;
    all.emplace_back("bad.rpdb");
    return depthRefused(kDepth, all);
  }

  const std::string kDepth = (kModels / "demo/depth.png").string();
  const std::string kCamera = (kModels / "demo/camera.json").string();
  std::string database_;
};

TEST_F(InputDamageTest, MissingDepth) {
  EXPECT_TRUE(depthRefused("none.png", {"none.png", "no such file"}));
}

TEST_F(InputDamageTest, EmptyDepth) {
  write("d.png", "");
  EXPECT_TRUE(depthRefused("d.png", {"d.png", "empty"}));
}

TEST_F(InputDamageTest, TruncatedDepth) {
  const std::string whole = readText(kDepth);
  for (const std::size_t size :
       {std::size_t{4}, std::size_t{30}, whole.size() / 2, whole.size() - 20}) {
    write("d.png", whole.substr(0, size));
    EXPECT_TRUE(depthRefused("d.png", {"d.png"})) << size;
  }
}

TEST_F(InputDamageTest, TextInPlaceOfDepth) {
  write("d.png", "hello, this is a text file and no picture\n");
  EXPECT_TRUE(depthRefused("d.png", {"d.png"}));
}

TEST_F(InputDamageTest, EightBitColourInPlaceOfDepth) {
  cv::imwrite((folder() / "d.png").string(), cv::Mat(480, 640, CV_8UC3, cv::Scalar(1, 2, 3)));
  EXPECT_TRUE(depthRefused("d.png", {"d.png"}));
}

TEST_F(InputDamageTest, FolderInPlaceOfDepth) {
  EXPECT_TRUE(depthRefused(folder().string(), {"not a regular file"}));
}

TEST_F(InputDamageTest, DepthOfAnotherSizeThanTheCamera) {
  cv::imwrite((folder() / "d.png").string(), cv::Mat(100, 200, CV_16UC1, cv::Scalar(500)));
  EXPECT_TRUE(depthRefused("d.png", {"200", "640"}));
}

TEST_F(InputDamageTest, DepthWithoutAMeasurement) {
  cv::imwrite((folder() / "d.png").string(), cv::Mat(480, 640, CV_16UC1, cv::Scalar(0)));
  EXPECT_TRUE(depthRefused("d.png", {"no measured pixel"}));
}

TEST_F(InputDamageTest, FloatTiffOfNaN) {
  const cv::Scalar nan(std::numeric_limits<double>::quiet_NaN());
  ASSERT_TRUE(cv::imwrite((folder() / "d.tif").string(), cv::Mat(480, 640, CV_32FC1, nan)));
  EXPECT_TRUE(depthRefused("d.tif", {"no measured pixel"}));
}

TEST_F(InputDamageTest, BadCameras) {
  const std::vector<std::pair<std::string, std::string>> cameras = {
      {"", "empty"},
      {"{", "c.json"},
      {"[1, 2]", "c.json"},
      {"{}", "cam_K"},
      {R"({"cam_K": [0,0,0,0,0,0,0,0,0], "depth_scale": 0.1})", "cam_K"},
      {R"({"cam_K": [570,0,320,0,0,240,0,0,1], "depth_scale": 0.1})", "c.json"},
      {R"({"cam_K": [570,0,320], "depth_scale": 0.1})", "cam_K"},
      {R"({"cam_K": [570,0,320,0,570,240,0,0,1], "depth_scale": 0})", "depth_scale"},
      {R"({"cam_K": [570,0,320,0,570,240,0,0,1], "depth_scale": "many"})", "depth_scale"},
  };
  for (const auto& [text, said] : cameras) {
    write("c.json", text);
    EXPECT_TRUE(refused({"--depth", kDepth, "--camera", "c.json"}, {said})) << text;
  }
  EXPECT_TRUE(refused({"--depth", kDepth, "--camera", "none.json"}, {"none.json"}));
}

TEST_F(InputDamageTest, BadBins) {
  write("b.json",
        R"({"cam_R_bin2c": [1,0,0,0,1,0,0,0,2], "cam_t_bin2c": [0,0,0], "inner_size": [1,1,1]})");
  EXPECT_TRUE(
      refused({"--depth", kDepth, "--camera", kCamera, "--bin", "b.json"}, {"cam_R_bin2c"}));
  write("b.json",
        R"({"cam_R_bin2c": [1,0,0,0,1,0,0,0,1], "cam_t_bin2c": [0,0,0], "inner_size": [1,0,1]})");
  EXPECT_TRUE(refused({"--depth", kDepth, "--camera", kCamera, "--bin", "b.json"}, {"inner_size"}));
}

TEST_F(InputDamageTest, BadClouds) {
  EXPECT_TRUE(refused({"--cloud", "none.ply"}, {"none.ply"}));
  write("c.ply", "");
  EXPECT_TRUE(refused({"--cloud", "c.ply"}, {"c.ply", "empty"}));
  write("c.ply", "neither PLY nor PCD");
  EXPECT_TRUE(refused({"--cloud", "c.ply"}, {"c.ply"}));
  write("c.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 9\nHEIGHT 1\nPOINTS "
        "9\n"
        "DATA ascii\n1 2 3\n");
  EXPECT_TRUE(refused({"--cloud", "c.pcd"}, {"c.pcd"}));
  write("c.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS "
        "2\n"
        "DATA ascii\nnan nan nan\nnan nan nan\n");
  EXPECT_TRUE(refused({"--cloud", "c.pcd"}, {}));
}

TEST_F(InputDamageTest, MissingDatabase) {
  database_ = "none.rpdb";
  EXPECT_TRUE(depthRefused(kDepth, {"none.rpdb", "rangepose build"}));
}

TEST_F(InputDamageTest, DamagedDatabase) {
  const std::string whole = readText(folder() / database_);
  ASSERT_GT(whole.size(), 10000U);
  EXPECT_TRUE(databaseRefused("", {}));
  EXPECT_TRUE(databaseRefused("not a database, but long enough for a header of one",
                              {"not a rangepose database"}));
  for (const std::size_t size :
       {std::size_t{6}, std::size_t{20}, whole.size() / 2, whole.size() - 1}) {
    EXPECT_TRUE(databaseRefused(whole.substr(0, size), {})) << size;
  }
  EXPECT_TRUE(databaseRefused(whole + "x", {}));
  for (const std::size_t at :
       {std::size_t{9}, std::size_t{18}, whole.size() / 3, whole.size() - 1}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    EXPECT_TRUE(databaseRefused(damaged, {})) << at;
  }
}

TEST_F(InputDamageTest, NewerDatabase) {
  std::string newer = readText(folder() / database_);
  newer[4] = 77;
  EXPECT_TRUE(databaseRefused(newer, {"version 77"}));
}

}  // namespace
}  // namespace rangepose::test
