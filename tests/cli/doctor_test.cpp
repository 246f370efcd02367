#include <gmock/gmock.h>

#include "cli/cli_fixture.h"
#include "support/backends.h"

namespace rangepose::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class DoctorTest : public CliTest {};

TEST_F(DoctorTest, NamesHostAndCuda) {
  const RunResult result = run({"doctor"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("cores +[0-9]+\n"));
  EXPECT_THAT(result.out, ContainsRegex("SIMD +[A-Z]"));
  EXPECT_THAT(result.out,
              ContainsRegex("cuda +(not built in|built with CUDA [0-9.]+|built for a device that "
                            "the host emulates: for tests)\n"));
  EXPECT_THAT(result.out, ContainsRegex("NVIDIA driver +(not )?found"));
  EXPECT_THAT(result.out, ContainsRegex("host +yes\n"));
  EXPECT_THAT(result.out,
              ContainsRegex("--path auto +takes (host|glsl|cuda); build renders by host"));
}

TEST_F(DoctorTest, SaysWhatThePathsLeaveToTheHost) {
  const RunResult result = run({"doctor"});
  if (result.out.find("glsl              no") != std::string::npos && !backendRequired("gles"))
    GTEST_SKIP() << "no OpenGL ES";
  EXPECT_THAT(result.out,
              ContainsRegex("glsl +yes.*; the host does its foreground, alignment, verdicts\n"));
}

TEST_F(DoctorTest, WithoutEglHostWorksAndTheRemedyIsNamed) {
  const RunResult result = run({"doctor"}, kNoEgl);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, ContainsRegex("glsl +no\n"));
  EXPECT_THAT(result.out, ContainsRegex("host +yes\n"));
  EXPECT_THAT(result.out, ContainsRegex("--path auto +takes host"));
  EXPECT_THAT(result.out, HasSubstr("libgl1-mesa-dri"));
  EXPECT_EQ(result.err, "");
}

TEST_F(DoctorTest, SaysWhatCudaLacks) {
  const RunResult result = run({"doctor", "--interop", "copy"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  if (cudaWorks()) {
    EXPECT_THAT(result.out, ContainsRegex("interop +copy: "));
  } else {
    EXPECT_THAT(
        result.out,
        ContainsRegex("cuda: (this program was built without|no NVIDIA driver|no CUDA device)"));
  }
}

TEST_F(DoctorTest, UnknownInteropIsAUsageError) {
  EXPECT_TRUE(failsWith(run({"doctor", "--interop", "wire"}), 2, {"--interop"}));
}

}  // namespace
}  // namespace rangepose::test
