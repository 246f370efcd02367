#include <gmock/gmock.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "cli/cli_fixture.h"
#include "eval/bop_folder.h"

namespace rangepose::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class EvaluateTest : public CliTest {
 protected:
  RunResult evaluate(const std::vector<BopEstimate>& rows,
                     const std::vector<std::string>& more = {}) const {
    writeBopCsv(folder() / "results.csv", rows);
    std::vector<std::string> arguments = {
        "evaluate", "--bop", data_.path().string(), "--csv", "results.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  BopFolderOfParts data_;
};

TEST_F(EvaluateTest, PerfectResultsAsMarkdown) {
  const RunResult result = evaluate(BopFolderOfParts::perfect());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(
      result.out,
      AllOf(
          HasSubstr("3 images, 9 estimates, 0.250 s an image"),
          HasSubstr("| all | 3 | 100.0 | 100.0 | 6 | 100.0 | 100.0 | 9 | 100.0 | 1.000 | 100.0 |"),
          HasSubstr("| 2 obj_000002 | 3 | 100.0 |"),
          HasSubstr("| all | 9 | 1.000 | 1.000 | 1.000 | 1.000 |")));
  EXPECT_THAT(files(), UnorderedElementsAre("results.csv")) << "nothing without --out";
}

TEST_F(EvaluateTest, TablesAndPlotsGoIntoTheFolder) {
  std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
  rows[0].camera_from_object.translation_mm.x += 40.0;
  const RunResult result = evaluate(rows, {"--out", "deep/report", "--min-visible", "0.2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(files(),
              UnorderedElementsAre("results.csv",
                                   "deep/report/table.md",
                                   "deep/report/table.csv",
                                   "deep/report/success.png",
                                   "deep/report/precision_recall.png",
                                   "deep/report/reliability.png"));
  EXPECT_EQ(readText(folder() / "deep/report/table.md"), result.out);
  EXPECT_THAT(readText(folder() / "deep/report/table.csv"),
              HasSubstr("\nall,3,0.666667,0.666667,9,0.888889,0.888889,9,0,0.888889,"));
  for (const char* name : {"success.png", "precision_recall.png", "reliability.png"}) {
    const cv::Mat picture = cv::imread((folder() / "deep/report" / name).string());
    EXPECT_GT(picture.cols, 600) << name;
    EXPECT_GT(picture.rows, 400) << name;
  }
}

TEST_F(EvaluateTest, NoEstimates) {
  const RunResult result = evaluate({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("| all | 3 | 0.0 | 0.0 | 6 | 0.0 | 0.0 | 0 | - | 0.000 |"));
}

TEST_F(EvaluateTest, BadInputIsOneLine) {
  std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
  rows[4].im_id = 99;
  EXPECT_TRUE(failsWith(evaluate(rows), 1, {"scene 4 image 99"}));
  rows = BopFolderOfParts::perfect();
  rows[4].obj_id = 7;
  EXPECT_TRUE(failsWith(evaluate(rows), 1, {"object 7", "obj_000007.ply"}));
  const std::string set = data_.path().string();
  write("broken.csv", "scene_id,im_id,obj_id,score,R,t,time\n4,0,1,0.5,1 0 0,0 0 1,0.1\n");
  EXPECT_TRUE(failsWith(
      run({"evaluate", "--bop", set, "--csv", "broken.csv"}), 1, {"broken.csv", "line 2"}));
  EXPECT_TRUE(failsWith(
      run({"evaluate", "--bop", set, "--csv", "none.csv"}), 1, {"none.csv", "no such file"}));
  EXPECT_TRUE(failsWith(
      evaluate(BopFolderOfParts::perfect(), {"--split", "val"}), 1, {"split val", "--split"}));
  fs::remove(data_.path() / "test/000004/scene_gt.json");
  EXPECT_TRUE(failsWith(evaluate(BopFolderOfParts::perfect()), 1, {"scene_gt.json"}));
}

TEST_F(EvaluateTest, WrongUsage) {
  EXPECT_TRUE(failsWith(run({"evaluate"}), 2, {"--bop"}));
  EXPECT_TRUE(failsWith(run({"evaluate", "--bop", "x"}), 2, {"--csv"}));
  EXPECT_TRUE(failsWith(
      evaluate(BopFolderOfParts::perfect(), {"--min-visible", "2"}), 2, {"--min-visible"}));
}

TEST_F(EvaluateTest, OutputFolderThatCannotBeMade) {
  write("taken", "a file");
  EXPECT_TRUE(failsWith(evaluate(BopFolderOfParts::perfect(), {"--out", "taken"}), 1, {"taken"}));
}

class EvaluatePaperTest : public CliTest {
 protected:
  RunResult paper(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "evaluate", "--paper", kModels.string(), "--bins", "1", "--sizes", "32", "--views", "100"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(EvaluatePaperTest, OneBinIsTwentyTrialsAndTwiceTheSame) {
  const std::vector<std::string> arguments = {
      "--sampling", "uniform", "--out", "report", "--contact-sheet"};
  const RunResult first = paper(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out,
              AllOf(HasSubstr("20 trials in 1 virtual bins, seed 1000, orthographic scan"),
                    HasSubstr("| t_pipe (20) | uniform | 32 | 100 | - |")));
  EXPECT_EQ(readText(folder() / "report/table.md"), first.out);
  const std::string trials = readText(folder() / "report/table.csv");
  EXPECT_EQ(std::count(trials.begin(), trials.end(), '\n'), 21);
  for (const char* name : {"times.png", "success.png", "sheet_bin0_t_pipe.png"}) {
    EXPECT_FALSE(cv::imread((folder() / "report" / name).string()).empty()) << name;
  }
  // The index names the pictures that are there, one for each failed trial.
  const std::string index = readText(folder() / "report/failures/index.md");
  std::size_t pictures = 0;
  for (const std::string& name : files()) {
    if (name.rfind("report/failures/", 0) != 0 || !name.ends_with(".png")) continue;
    ++pictures;
    EXPECT_THAT(index, HasSubstr(name.substr(16)));
  }
  EXPECT_THAT(index, HasSubstr(std::to_string(pictures) + " failed trials"));
  ASSERT_EQ(paper({"--sampling", "uniform", "--out", "again", "--threads", "1"}).exit_code, 0);
  EXPECT_EQ(readText(folder() / "again/table.csv"), trials) << "whatever the number of threads";
}

TEST_F(EvaluatePaperTest, PerspectiveScansWithNoise) {
  const RunResult result =
      paper({"--sampling", "uniform", "--camera", "perspective", "--sensor", "structured-light"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("perspective scan by structured-light"));
}

TEST_F(EvaluatePaperTest, BadInputIsOneLine) {
  EXPECT_TRUE(failsWith(run({"evaluate", "--paper", "nowhere"}), 1, {"nowhere/t_pipe.ply"}));
  EXPECT_TRUE(failsWith(paper({"--sensor", "eye"}), 2, {"--sensor"}));
  EXPECT_TRUE(failsWith(paper({"--contact-sheet"}), 2, {"--contact-sheet", "--out"}));
  EXPECT_TRUE(failsWith(paper({"--bop", "x"}), 2, {"--bop", "--paper"}));
  EXPECT_TRUE(failsWith(paper({"--sampling", "random"}), 2, {"--sampling"}));
}

}  // namespace
}  // namespace rangepose::test
