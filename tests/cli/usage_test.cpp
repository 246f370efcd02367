#include <gmock/gmock.h>

#include <ostream>

#include "cli/cli_fixture.h"

namespace rangepose::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

class UsageTest : public CliTest {};

TEST_F(UsageTest, VersionIsThatOfTheProject) {
  const RunResult result = run({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "rangepose " RP_VERSION "\n");
  EXPECT_EQ(result.err, "");
}

TEST_F(UsageTest, HelpNamesAllCommandsAndExitCodes) {
  const RunResult result = run({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* word : {"doctor", "build", "estimate", "compare", "Exit codes"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

TEST_F(UsageTest, HelpOfEachCommandHasExamples) {
  for (const char* command : {"doctor", "build", "estimate", "compare"}) {
    const RunResult result = run({command, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr(std::string("Examples:\n  rangepose ") + command));
    EXPECT_EQ(result.err, "");
  }
}

struct BadUsage {
  std::string name;
  Words arguments;
  Words said;
};

/// The name of the test says it all.
void PrintTo(const BadUsage& usage, std::ostream* out) { *out << usage.name; }

const BadUsage kBadUsages[] = {
    {"NoCommand", {}, {"subcommand"}},
    {"UnknownCommand", {"guess"}, {"guess"}},
    {"UnknownOption", {"--frobnicate"}, {"--frobnicate"}},
    {"UnknownOptionOfCommand", {"estimate", "--frobnicate"}, {"--frobnicate", "estimate --help"}},
    {"BuildWithoutModel", {"build", "-o", "a.rpdb"}, {"no model", "--bop"}},
    {"BuildWithoutOutput", {"build", "a.ply"}, {"--out"}},
    {"BuildModelsAndBop", {"build", "a.ply", "--bop", "d", "-o", "a.rpdb"}, {"--bop"}},
    {"BuildSampling", {"build", "a.ply", "-o", "a.rpdb", "--sampling", "best"}, {"best"}},
    {"BuildNoViews", {"build", "a.ply", "-o", "a.rpdb", "--views", "0"}, {"--views"}},
    {"BuildHugeViews", {"build", "a.ply", "-o", "a.rpdb", "--size", "4096"}, {"--size"}},
    {"BuildUnit", {"build", "a.ply", "-o", "a.rpdb", "--unit", "mile"}, {"--unit", "mile"}},
    {"NoDatabase", {"estimate", "--depth", "d", "--camera", "c"}, {"--db"}},
    {"NoScene", {"estimate", "--db", "a"}, {"--depth", "--cloud"}},
    {"NoCamera", {"estimate", "--db", "a", "--depth", "d"}, {"--camera"}},
    {"DepthAndCloud",
     {"estimate", "--db", "a", "--depth", "d", "--camera", "c", "--cloud", "p"},
     {"--cloud"}},
    {"UnitOfDepth",
     {"estimate", "--db", "a", "--depth", "d", "--camera", "c", "--unit", "m"},
     {"depth_scale"}},
    {"CsvWithoutBop", {"estimate", "--db", "a", "--cloud", "p", "--csv", "r"}, {"--csv", "--bop"}},
    {"SplitWithoutBop",
     {"estimate", "--db", "a", "--cloud", "p", "--split", "val"},
     {"--split", "--bop"}},
    {"ResumeWithoutBop",
     {"estimate", "--db", "a", "--cloud", "p", "--resume"},
     {"--resume", "--bop"}},
    {"BopWithoutCsv", {"estimate", "--db", "a", "--bop", "d"}, {"--csv"}},
    {"BopAndDepth",
     {"estimate", "--db", "a", "--bop", "d", "--csv", "r", "--depth", "d"},
     {"--bop"}},
    {"BopAndJson",
     {"estimate", "--db", "a", "--bop", "d", "--csv", "r", "--json", "j"},
     {"--json"}},
    {"BopAndBin", {"estimate", "--db", "a", "--bop", "d", "--csv", "r", "--bin", "b"}, {"--bin"}},
    {"BopAndWorkspace",
     {"estimate", "--db", "a", "--bop", "d", "--csv", "r", "--arm", "0", "0", "1"},
     {"--arm", "--bop"}},
    {"ConeTooWide",
     {"estimate", "--db", "a", "--cloud", "p", "--approach-cone", "90"},
     {"--approach-cone", "90"}},
    {"NanCone",
     {"estimate", "--db", "a", "--cloud", "p", "--approach-cone", "nan"},
     {"--approach-cone"}},
    {"FreedomAboveOne",
     {"estimate", "--db", "a", "--cloud", "p", "--min-freedom", "2"},
     {"--min-freedom"}},
    {"WorkspaceInsideOut",
     {"estimate", "--db", "a", "--cloud", "p", "--workspace", "0", "9", "5", "5", "0", "9"},
     {"--workspace", "Y0 5 is not below Y1 5"}},
    {"WorkspaceOfFour",
     {"estimate", "--db", "a", "--cloud", "p", "--workspace", "0", "9", "0", "9"},
     {"--workspace"}},
    {"ArmNowhere", {"estimate", "--db", "a", "--cloud", "p", "--arm", "0", "inf", "0"}, {"--arm"}},
    {"FirstAndAll",
     {"estimate", "--db", "a", "--cloud", "p", "--first", "--all"},
     {"--first", "--all"}},
    {"AllAndMax",
     {"estimate", "--db", "a", "--cloud", "p", "--all", "--max-poses", "3"},
     {"--max-poses"}},
    {"UnknownPath",
     {"estimate", "--db", "a", "--cloud", "p", "--path", "vulkan"},
     {"--path", "vulkan"}},
    {"NoNumber",
     {"estimate", "--db", "a", "--cloud", "p", "--starts", "many"},
     {"--starts", "many"}},
    {"NanScore", {"estimate", "--db", "a", "--cloud", "p", "--min-score", "nan"}, {"--min-score"}},
    {"ScoreAboveOne",
     {"estimate", "--db", "a", "--cloud", "p", "--min-score", "1.5"},
     {"--min-score"}},
    {"NegativeThreads",
     {"estimate", "--db", "a", "--cloud", "p", "--threads", "-1"},
     {"--threads"}},
    {"OnePath", {"compare", "--db", "a", "--cloud", "p", "--paths", "host"}, {"--paths"}},
    {"PathTwice", {"compare", "--db", "a", "--cloud", "p", "--paths", "host,host"}, {"twice"}},
    {"UnknownPaths", {"compare", "--db", "a", "--cloud", "p", "--paths", "host,moon"}, {"moon"}},
};

class BadUsageTest : public CliTest, public ::testing::WithParamInterface<BadUsage> {};

TEST_P(BadUsageTest, IsExitCodeTwoAndOneLine) {
  EXPECT_TRUE(failsWith(run(GetParam().arguments), 2, GetParam().said));
  EXPECT_TRUE(files().empty());
}

INSTANTIATE_TEST_SUITE_P(All, BadUsageTest, ::testing::ValuesIn(kBadUsages), [](const auto& bad) {
  return bad.param.name;
});

}  // namespace
}  // namespace rangepose::test
