// rangepose evaluate --scans.
#include <gmock/gmock.h>

#include <algorithm>

#include "cli/cli_fixture.h"
#include "eval/bop_folder.h"

namespace rangepose::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class EvaluateScansTest : public CliTest {
 protected:
  std::string set() const { return data_.path().string(); }

  BopFolderOfParts data_;
};

TEST_F(EvaluateScansTest, AColumnForEachSetInOrder) {
  fs::copy(data_.path(), folder() / "other", fs::copy_options::recursive);
  write("other/test/000004/scene_gt.json", "{}");
  write("one.json", "{\"2\":[" + poseJson(1, BopFolderOfParts::truth(2, 0)) + "]}");
  const RunResult result = run({"evaluate",
                                "--scans",
                                set(),
                                "--scans",
                                "other",
                                "--truth",
                                "-",
                                "--truth",
                                "one.json",
                                "--out",
                                "report"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("| figure | " + data_.path().filename().string() +
                              " (3 images, 6 parts) | other (1 images, 1 parts) |\n"),
                    HasSubstr("| common step of all depth values [mm] | 0.100 | 0.100 |"),
                    HasSubstr("| lost of the silhouettes [%] | 0.0 | 0.0 |")));
  EXPECT_EQ(readText(folder() / "report/table.md"), result.out);
  EXPECT_THAT(readText(folder() / "report/table.csv"),
              HasSubstr("\"images\",3,1\n\"parts\",6,1\n"));
}

TEST_F(EvaluateScansTest, SameTableOnAnyNumberOfThreads) {
  const RunResult one = run({"evaluate", "--scans", set(), "--threads", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(run({"evaluate", "--scans", set(), "--threads", "3"}).out, one.out);
}

TEST_F(EvaluateScansTest, WrongUsage) {
  EXPECT_TRUE(failsWith(run({"evaluate", "--truth", "x.json"}), 2, {"--truth", "--scans"}));
  EXPECT_TRUE(failsWith(run({"evaluate", "--scans", "a", "--scans", "b", "--truth", "-"}),
                        2,
                        {"1 --truth for 2 --scans"}));
  EXPECT_TRUE(failsWith(
      run({"evaluate", "--scans", set(), "--bop", set()}), 2, {"--bop", "--scans", "one of"}));
}

TEST_F(EvaluateScansTest, BadInputIsOneLine) {
  EXPECT_TRUE(failsWith(run({"evaluate", "--scans", "nowhere"}), 1, {"nowhere"}));
  EXPECT_TRUE(failsWith(
      run({"evaluate", "--scans", set(), "--truth", "none.json"}), 1, {"none.json", "no such"}));
  EXPECT_TRUE(failsWith(
      run({"evaluate", "--scans", set(), "--split", "val"}), 1, {"no image", "check split"}));
  write("poses.json", "{\"0\":[" + poseJson(9, BopFolderOfParts::truth(0, 0)) + "]}");
  EXPECT_TRUE(
      failsWith(run({"evaluate", "--scans", set(), "--truth", "poses.json"}), 1, {"object 9"}));
  fs::remove(data_.path() / "test/000004/scene_gt.json");
  EXPECT_TRUE(failsWith(
      run({"evaluate", "--scans", set()}), 1, {"scene_gt.json", "no such file", "--truth"}));
}

}  // namespace
}  // namespace rangepose::test
