// Grades that are kept. Where one does not come back as it was, a second run tells other figures.
#include "gate/tally_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace rangepose::gate {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

ImageTally fullTally() {
  ImageTally tally;
  tally.id = {3, 7};
  tally.parts = 4;
  tally.first_right = false;
  tally.shown = {{0.1 + 0.2, PoseVerdict::kFound, 1.0 / 3.0}, {0.6, PoseVerdict::kFalse, kNothing}};
  tally.found_as_seen = 2;
  tally.false_as_seen = 1;
  tally.checked = {{0.05, PoseVerdict::kIgnored, 0.09}};
  tally.time_s = 1.25e-3;
  return tally;
}

void expectSame(const std::vector<JudgedPose>& a, const std::vector<JudgedPose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].score, b[i].score);
    EXPECT_EQ(a[i].verdict, b[i].verdict);
    EXPECT_TRUE(a[i].error == b[i].error || (std::isnan(a[i].error) && std::isnan(b[i].error)));
  }
}

TEST(TallyFile, AllComesBackBitByBit) {
  ImageTally empty;
  empty.holds_none = true;
  empty.time_s = kNothing;
  const CellTallies tallies{{fullTally(), empty}, {{empty}, {fullTally()}}};
  const CellTallies read = talliesFrom(talliesText(tallies), "here");
  ASSERT_EQ(read.all.size(), 2u);
  const ImageTally& full = read.all[0];
  EXPECT_EQ(full.id, ImageId(3, 7));
  EXPECT_EQ(full.parts, 4);
  EXPECT_EQ(full.first_right, std::optional<bool>(false));
  EXPECT_EQ(full.found_as_seen, 2);
  EXPECT_EQ(full.false_as_seen, 1);
  EXPECT_EQ(full.time_s, 1.25e-3);
  EXPECT_FALSE(full.holds_none);
  expectSame(full.shown, fullTally().shown);
  expectSame(full.checked, fullTally().checked);
  EXPECT_TRUE(read.all[1].holds_none);
  EXPECT_FALSE(read.all[1].first_right.has_value());
  EXPECT_TRUE(std::isnan(read.all[1].time_s));
  ASSERT_EQ(read.of_part.size(), 2u);
  EXPECT_EQ(read.of_part[1][0].parts, 4);
}

TEST(TallyFile, DamagedTextsAreRefused) {
  EXPECT_THROW(talliesFrom("", "here"), Error);
  EXPECT_THROW(talliesFrom("{}", "here"), Error);
  std::string text = talliesText({{fullTally()}, {}});
  text.replace(text.find("\"parts\":4"), 9, "\"parts\":\"\"");
  EXPECT_THROW(talliesFrom(text, "here"), Error);
}

}  // namespace
}  // namespace rangepose::gate
