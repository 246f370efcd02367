#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "cli/cli_fixture.h"
#include "support/backends.h"

namespace rangepose::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class CompareTest : public CliTest {
 protected:
  RunResult compare(const std::vector<std::string>& more,
                    const std::vector<std::string>& environment = {}) const {
    std::vector<std::string> arguments = {"compare",
                                          "--db",
                                          smallDatabase(),
                                          "--depth",
                                          (kModels / "demo/depth.png").string(),
                                          "--camera",
                                          (kModels / "demo/camera.json").string(),
                                          "--starts",
                                          "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, environment);
  }
};

TEST_F(CompareTest, ShowsEachStageOfBothPaths) {
  const RunResult text = compare({"--json", "c.json"});
  if (text.exit_code == 3 && !backendRequired("gles")) GTEST_SKIP() << text.err;
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("isolated"));
  EXPECT_THAT(text.out, HasSubstr("chained"));
  const json answer = json::parse(readText(folder() / "c.json"));
  ASSERT_EQ(answer.at("comparisons").size(), 1U);
  const json& comparison = answer.at("comparisons").at(0);
  EXPECT_EQ(comparison.at("reference"), "host");
  EXPECT_EQ(comparison.at("subject"), "glsl");
  EXPECT_GT(comparison.at("draws").get<int>(), 0);
  EXPECT_EQ(comparison.at("left_to_host"), "foreground, alignment, verdicts");
  EXPECT_THAT(text.out, HasSubstr("glsl leaves to the host: foreground, alignment, verdicts\n"));
  ASSERT_GE(comparison.at("isolated").size(), 5U);
  for (const json& stage : comparison.at("isolated")) {
    EXPECT_GT(stage.at("total").get<int>(), 0) << stage;
    EXPECT_LE(stage.at("differing").get<int>(), stage.at("total").get<int>()) << stage;
  }
}

TEST_F(CompareTest, JsonOnStdoutIsAlone) {
  const RunResult result = compare({"--json", "-"});
  if (result.exit_code == 3 && !backendRequired("gles")) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(json::accept(result.out));
}

TEST_F(CompareTest, PictureHasBothPathsAndTheirDifference) {
  const RunResult result = compare({"--picture", "p.png"});
  if (result.exit_code == 3 && !backendRequired("gles")) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const cv::Mat picture = cv::imread((folder() / "p.png").string());
  // Three panels wide, and many stages high.
  EXPECT_GT(picture.cols, 3 * 300);
  EXPECT_GT(picture.rows, 6 * 200);
}

TEST_F(CompareTest, AllThreePathsStandSideBySide) {
  if (!cudaWorks()) GTEST_SKIP() << "no CUDA device, nor an emulated one";
  const RunResult two = compare({"--paths", "host,glsl", "--picture", "two.png"});
  const RunResult three = compare({"--paths", "host,glsl,cuda", "--picture", "three.png"});
  ASSERT_EQ(three.exit_code, 0) << three.err;
  EXPECT_THAT(three.out, ::testing::HasSubstr("cuda made "));
  EXPECT_GT(cv::imread((folder() / "three.png").string()).cols,
            cv::imread((folder() / "two.png").string()).cols);
}

TEST_F(CompareTest, PathsThatAreNotHereAreExitCodeThree) {
  if (!cudaWorks()) {
    EXPECT_TRUE(failsWith(compare({"--paths", "host,cuda", "--json", "c.json"}), 3, {"cuda"}));
  }
  EXPECT_TRUE(failsWith(compare({"--json", "c.json"}, kNoEgl), 3, {"OpenGL ES"}));
  EXPECT_FALSE(std::filesystem::exists(folder() / "c.json"));
}

}  // namespace
}  // namespace rangepose::test
