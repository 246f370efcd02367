#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

class EstimateOutputTest : public CliTest {};

/// Rows have length one to the precision of a double: nothing was rounded.
void expectExactRotation(const json& rows) {
  ASSERT_EQ(rows.size(), 9U);
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = rows.at(3 * row + i);
      sum += value * value;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

void expectFiniteNumbers(const json& value) {
  EXPECT_FALSE(value.is_null());
  if (value.is_structured()) {
    for (const json& entry : value) expectFiniteNumbers(entry);
  }
}

TEST_F(EstimateOutputTest, JsonHasAllFields) {
  ASSERT_EQ(run(demoArguments({"--json", "poses.json", "--all"})).exit_code, 0);
  const json answer = json::parse(readText(folder() / "poses.json"));
  EXPECT_EQ(answer.at("version"), RP_VERSION);
  EXPECT_EQ(answer.at("image"), (kModels / "demo/depth.png").string());
  EXPECT_TRUE(answer.at("path") == "host" || answer.at("path") == "glsl");
  EXPECT_GT(answer.at("sensor").at("noise_mm").get<double>(), 0.0);
  EXPECT_GE(answer.at("sensor").at("lost").get<double>(), 0.0);
  EXPECT_TRUE(answer.at("warnings").is_array());
  EXPECT_GT(answer.at("times_ms").at("rough search").get<double>(), 0.0);
  expectFiniteNumbers(answer);
  ASSERT_FALSE(answer.at("poses").empty());
  EXPECT_EQ(answer.at("out_of_reach"), 0);
  int order = 0;
  for (const json& pose : answer.at("poses")) {
    EXPECT_EQ(pose.at("order"), ++order);
    EXPECT_GT(pose.at("freedom").get<double>(), 0.0);
    EXPECT_LE(pose.at("freedom").get<double>(), 1.0);
    EXPECT_LT(pose.at("height_mm").get<double>(), 0.0) << "below the camera";
    EXPECT_EQ(pose.at("approach"), json::array({0.0, 0.0, 1.0}));
    EXPECT_EQ(pose.at("object"), "elbow");
    EXPECT_EQ(pose.at("obj_id"), 1);
    expectExactRotation(pose.at("cam_R_m2c"));
    EXPECT_EQ(pose.at("cam_t_m2c").size(), 3U);
    EXPECT_EQ(pose.at("rough").at("R").size(), 9U);
    EXPECT_EQ(pose.at("rough").at("t").size(), 3U);
    EXPECT_GT(pose.at("rough").at("error").get<double>(), 0.0);
    EXPECT_LT(pose.at("rough").at("view").get<int>(), 400);
    double shares = 0.0;
    for (const char* part : {"explained", "contradicted", "hidden", "buried", "missing", "weak"}) {
      shares += pose.at("check").at(part).get<double>();
    }
    EXPECT_NEAR(shares, 1.0, 1e-6);
    EXPECT_GE(pose.at("check").at("outline").get<double>(), 0.0);
    EXPECT_GE(pose.at("check").at("residual_mm").get<double>(), 0.0);
    double log_odds = 0.0;
    for (const auto& term : pose.at("evidence")) log_odds += term.get<double>();
    // Rivals have their share of it, and few pixels bound it.
    EXPECT_LE(pose.at("score").get<double>(), 1.0 / (1.0 + std::exp(-log_odds)) + 1e-9);
  }
}

/// The JSON text without its times.
std::string withoutTimes(const std::string& text) {
  nlohmann::ordered_json answer = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(answer.erase("times_ms"), 1U);
  return answer.dump();
}

TEST_F(EstimateOutputTest, SameInputGivesSameAnswerWithAnyNumberOfThreads) {
  const std::vector<std::string> arguments = demoArguments({"--json", "-", "--max-poses", "2"});
  const RunResult first = run(arguments);
  ASSERT_EQ(first.exit_code, 0);
  EXPECT_EQ(withoutTimes(first.out), withoutTimes(run(arguments).out));
  std::vector<std::string> one_thread = arguments;
  one_thread.insert(one_thread.end(), {"--threads", "1"});
  EXPECT_EQ(withoutTimes(first.out), withoutTimes(run(one_thread).out));
}

TEST_F(EstimateOutputTest, OverlayAndDumpDecode) {
  const RunResult result =
      run(demoArguments({"--overlay", "seen.png", "--dump", "stages", "--max-poses", "2"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(cv::imread((folder() / "seen.png").string()).cols, 1200);
  const std::string page = readText(folder() / "stages/index.html");
  int pictures = 0;
  for (const std::string& name : files()) {
    if (name.rfind("stages/", 0) != 0 || name == "stages/index.html") continue;
    EXPECT_FALSE(cv::imread((folder() / name).string()).empty()) << name;
    EXPECT_NE(page.find(name.substr(7)), std::string::npos) << name << " is not on the page";
    ++pictures;
  }
  EXPECT_GE(pictures, 12);
}

TEST_F(EstimateOutputTest, DumpShowsTheObjectThatWon) {
  const RunResult built = run({"build",
                               (kModels / "bolt.ply").string(),
                               (kModels / "elbow.ply").string(),
                               "-o",
                               "two.rpdb",
                               "--views",
                               "400",
                               "--path",
                               "host"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const RunResult result = run({"estimate",
                                "--db",
                                "two.rpdb",
                                "--depth",
                                (kModels / "demo/depth.png").string(),
                                "--camera",
                                (kModels / "demo/camera.json").string(),
                                "--dump",
                                "stages",
                                "--json",
                                "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("poses").at(0).at("obj_id"), 2);
  std::string names;
  for (const std::string& name : files()) names += name + " ";
  EXPECT_THAT(names, ::testing::HasSubstr("atlas_bolt"));
  EXPECT_THAT(names, ::testing::HasSubstr("atlas_elbow"));
}

TEST_F(EstimateOutputTest, OutputsThatCannotBeWrittenFailBeforeTheWork) {
  for (const char* option : {"--json", "--overlay"}) {
    const RunResult result = run(demoArguments({option, "nowhere/file"}));
    EXPECT_TRUE(failsWith(result, 1, {"nowhere/file"}));
  }
  write("plain", "a file");
  EXPECT_TRUE(failsWith(run(demoArguments({"--dump", "plain"})), 1, {"plain"}));
  EXPECT_THAT(files(), ElementsAre("elbow.rpdb", "plain"));
}

}  // namespace
}  // namespace rangepose::test
