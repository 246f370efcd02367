// A run over a data set that is interrupted loses nothing but the image at hand.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

constexpr int kImages = 4;
constexpr const char* kSideFile = "r.csv.partial";

class BopResumeTest : public CliTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder() / "set/test/000003/depth");
    std::string cameras;
    for (int i = 0; i < kImages; ++i) {
      const std::string id = std::to_string(i);
      fs::copy_file(kModels / "demo/depth.png",
                    folder() / ("set/test/000003/depth/00000" + id + ".png"));
      cameras += (i > 0 ? ", \"" : "{\"") + id +
                 R"(": {"cam_K": [570,0,319.5,0,570,239.5,0,0,1], "depth_scale": 0.1})";
    }
    write("set/test/000003/scene_camera.json", cameras + "}");
  }

  Words arguments(const std::string& csv, const Words& more = {}) const {
    Words all = {"estimate", "--db", elbowDatabase(), "--bop", "set", "--csv", csv};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// Kills a run once it has kept `images`.
  void interrupt(int images) const {
    const auto kept = [&] {
      const std::string text = readText(folder() / kSideFile);
      int count = 0;
      for (std::size_t at = 0; (at = text.find("\nimage ", at)) != std::string::npos; ++at) ++count;
      return count >= images;
    };
    // On a busy machine it may be done before this process gets its turn: then once more.
    constexpr int kMostRuns = 100;
    for (int i = 0; i < kMostRuns; ++i) {
      const RunResult result = runRangeposeUntil(kept, SIGKILL, arguments("r.csv"), folder());
      if (!fs::exists(folder() / "r.csv")) {
        ASSERT_EQ(result.exit_code, 128 + SIGKILL) << result.err;
        return;
      }
      fs::remove(folder() / "r.csv");
    }
    FAIL() << "it was always done before it could be interrupted";
  }

  void append(const std::string& text) const {
    write(kSideFile, readText(folder() / kSideFile) + text);
  }
};

/// The rows without their times, which are those of the clock.
Words rowsWithoutTimes(const fs::path& csv) {
  Words rows;
  std::string text = readText(csv);
  for (std::size_t end = 0; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
    const std::string row = text.substr(0, end);
    rows.push_back(row.substr(0, row.rfind(',')));
  }
  return rows;
}

TEST_F(BopResumeTest, ResumedRunGivesTheRowsOfAnUninterruptedOne) {
  ASSERT_EQ(run(arguments("whole.csv")).exit_code, 0);
  interrupt(2);
  const std::string kept = readText(folder() / kSideFile);
  append("image 3 2 0.5 : 9 0123");  // the machine went down while this was written
  const RunResult result = run(arguments("r.csv", {"--resume"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("4 of 4 images"));
  EXPECT_THAT(result.out, HasSubstr("images from the run before"));
  const Words rows = rowsWithoutTimes(folder() / "r.csv");
  EXPECT_EQ(rows, rowsWithoutTimes(folder() / "whole.csv"));
  EXPECT_GE(rows.size(), 5U) << "a header, and a pose in each image";
  EXPECT_FALSE(fs::exists(folder() / kSideFile));
  // Images that were done are not done again: their rows have the times of the first run.
  const std::size_t row = kept.find("\n3,0,");
  ASSERT_NE(row, std::string::npos);
  EXPECT_THAT(readText(folder() / "r.csv"),
              HasSubstr(kept.substr(row, kept.find('\n', row + 1) - row)));
}

TEST_F(BopResumeTest, WhatWasInterruptedIsNotOverwrittenUnasked) {
  interrupt(1);
  const std::string kept = readText(folder() / kSideFile);
  EXPECT_TRUE(failsWith(run(arguments("r.csv")), 1, {kSideFile, "--resume", "delete it"}));
  EXPECT_EQ(readText(folder() / kSideFile), kept);
}

TEST_F(BopResumeTest, OtherSettingsAreRefused) {
  interrupt(1);
  EXPECT_TRUE(failsWith(run(arguments("r.csv", {"--resume", "--min-score", "0.3"})),
                        1,
                        {kSideFile, "then --min-score = 0.5, now --min-score = 0.3"}));
  EXPECT_TRUE(failsWith(
      run({"estimate", "--db", smallDatabase(), "--bop", "set", "--csv", "r.csv", "--resume"}),
      1,
      {kSideFile, "database"}));
}

TEST_F(BopResumeTest, DamageIsNamed) {
  interrupt(1);
  const std::string good = readText(folder() / kSideFile);
  std::string damaged = good;
  damaged.at(damaged.rfind(',') - 3) ^= 1;  // a digit of a pose
  write(kSideFile, damaged);
  EXPECT_TRUE(failsWith(run(arguments("r.csv", {"--resume"})),
                        1,
                        {kSideFile, "damaged at \"image 3 ", "delete it to start anew"}));
  EXPECT_EQ(readText(folder() / kSideFile), damaged) << "what is left in it is not lost";
  for (const std::string& text :
       {std::string("no results"), std::string("no results\n"), good.substr(0, 40)}) {
    write(kSideFile, text);
    EXPECT_TRUE(failsWith(run(arguments("r.csv", {"--resume"})), 1, {kSideFile, "damaged"}));
  }
  EXPECT_FALSE(fs::exists(folder() / "r.csv"));
}

TEST_F(BopResumeTest, NothingToResumeIsAWholeRun) {
  const RunResult result = run(arguments("r.csv", {"--resume"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(rowsWithoutTimes(folder() / "r.csv").size(), 5U);
  EXPECT_FALSE(fs::exists(folder() / kSideFile));
}

TEST_F(BopResumeTest, BesideADeviceNothingIsKept) {
  const RunResult result = run(arguments("/dev/null"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists("/dev/null.partial"));
}

}  // namespace
}  // namespace rangepose::test
