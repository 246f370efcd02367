#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/run_rangepose.h"
#include "support/temp_folder.h"

namespace rangepose::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

const std::string kPpf = RP_PPF_EXECUTABLE;

class PpfProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kPpf.empty()) {
      GTEST_SKIP() << "rangepose_ppf is not built: OpenCV has no surface_matching here; install "
                      "libopencv-contrib-dev";
    }
  }
  const fs::path& folder() const { return folder_.path(); }
  RunResult rangepose(const std::vector<std::string>& arguments) const {
    return runRangepose(arguments, folder());
  }
  RunResult ppf(const std::vector<std::string>& arguments) const {
    return runProgram(kPpf, arguments, folder());
  }
  /// A bin with nothing but one crank, and a database of it.
  void makeBin() const {
    const std::string part = RP_MODELS_DIR "/tuning/crank.ply";
    RunResult made = rangepose({"simulate",
                                part,
                                "-o",
                                "bin",
                                "--bins",
                                "1",
                                "--count",
                                "1",
                                "--sensor",
                                "none",
                                "--camera-distance",
                                "600"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    made = rangepose({"build", "--bop", "bin", "-o", "crank.rpdb", "--views", "128"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

 private:
  TempFolder folder_;
};

TEST_F(PpfProgramTest, FindsALonePartAndItsResultsCanBeEvaluated) {
  makeBin();
  const RunResult found = ppf({"--db", "crank.rpdb", "--bop", "bin", "--csv", "ppf.csv"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("1 images, 1 poses"));
  const RunResult graded = rangepose({"evaluate", "--bop", "bin", "--csv", "ppf.csv"});
  ASSERT_EQ(graded.exit_code, 0) << graded.err;
  // Images, first pick, the same at 2 %, parts, recall, the same at 2 %.
  EXPECT_THAT(graded.out, HasSubstr("| all | 1 | 100.0 | 100.0 | 1 | 100.0 | 100.0 |"));
}

TEST_F(PpfProgramTest, TheNumberOfThreadsDoesNotChangeTheResult) {
  makeBin();
  const auto rows = [&](const std::string& threads) {
    const RunResult found =
        ppf({"--db", "crank.rpdb", "--bop", "bin", "--csv", "ppf.csv", "--threads", threads});
    EXPECT_EQ(found.exit_code, 0) << found.err;
    const RunResult text = runProgram("/usr/bin/cut", {"-d,", "-f1-6", "ppf.csv"}, folder());
    return text.out;
  };
  const std::string one = rows("1");
  EXPECT_THAT(one, HasSubstr("\n1,0,1,"));
  EXPECT_EQ(rows("3"), one);
}

TEST_F(PpfProgramTest, BadInputIsOneLine) {
  const RunResult missing = ppf({"--db", "none.rpdb", "--bop", "nowhere", "--csv", "ppf.csv"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, ContainsRegex("^rangepose_ppf: [^\n]*nowhere[^\n]*\n$"));
  EXPECT_EQ(ppf({"--db", "none.rpdb"}).exit_code, 2);
}

}  // namespace
}  // namespace rangepose::test
