#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The demo: parts lie left and right of the camera's axis.
class PickingTest : public CliTest {
 protected:
  json found(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"--json", "-"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(demoArguments(all));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
};

double x(const json& pose) { return pose.at("cam_t_m2c").at(0); }

TEST_F(PickingTest, BestPoseWithinTheWorkspaceThoughASurerOneIsOutside) {
  const json anywhere = found({"--first"});
  ASSERT_EQ(anywhere.at("poses").size(), 1U);
  const bool right = x(anywhere.at("poses").at(0)) > 0.0;
  const std::vector<std::string> other_side = {
      "--workspace", right ? "-500" : "10", right ? "-10" : "500", "-500", "500", "0", "2000"};
  const json within = found(other_side);
  ASSERT_EQ(within.at("poses").size(), 1U);
  EXPECT_GE(within.at("out_of_reach"), 1);
  EXPECT_NE(x(within.at("poses").at(0)) > 0.0, right);
}

TEST_F(PickingTest, NothingWithinReachIsAnAnswerThatSaysSo) {
  const RunResult result = run(demoArguments({"--workspace", "5000", "5001", "0", "1", "0", "1"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("poses found, none of them within reach"));
}

TEST_F(PickingTest, LeaningToolFindsPartsNoLessFree) {
  const json straight = found({"--all"});
  const json leaning = found({"--all", "--approach-cone", "25"});
  ASSERT_EQ(straight.at("poses").size(), leaning.at("poses").size());
  double sum = 0.0;
  for (const json& pose : leaning.at("poses")) {
    sum += pose.at("freedom").get<double>();
    EXPECT_GT(pose.at("approach").at(2).get<double>(), 0.9) << "cos(25 degrees)";
  }
  for (const json& pose : straight.at("poses")) sum -= pose.at("freedom").get<double>();
  EXPECT_GT(sum, 0.01);
}

TEST_F(PickingTest, CoveredPartsAreLeftOutOnRequest) {
  const json free = found({"--all", "--min-freedom", "0.9"});
  EXPECT_GE(free.at("out_of_reach"), 1) << "parts of the heap lie under others";
  ASSERT_FALSE(free.at("poses").empty());
  for (const json& pose : free.at("poses")) EXPECT_GE(pose.at("freedom").get<double>(), 0.9);
}

}  // namespace
}  // namespace rangepose::test
