#include <gmock/gmock.h>

#include "cli/cli_fixture.h"

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
  EXPECT_THAT(result.out, ContainsRegex("cuda +not built in\n"));
  EXPECT_THAT(result.out, ContainsRegex("NVIDIA driver +(not )?found"));
  EXPECT_THAT(result.out, ContainsRegex("host +yes\n"));
  EXPECT_THAT(result.out, ContainsRegex("--path auto +takes (host|glsl)"));
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

}  // namespace
}  // namespace rangepose::test
