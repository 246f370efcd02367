// The check of the short gate. Where it lets a loss pass, users meet it first.
#include "gate/short_check.h"

#include <gmock/gmock.h>

#include <limits>

#include "core/error.h"
#include "gate/gate_rows.h"
#include "support/temp_folder.h"

namespace rangepose::gate {
namespace {

constexpr const char* kFile = R"({
  "recipes": {"sensors": [{"name": "tof"}],
              "sets": [{"name": "short", "seed": 8200, "kinds": [{"name": "bolt", "parts": ["a"]}]}]},
  "slack": {"recall": 0.03, "brier": 0.01, "mean_right": 0.01, "mean_wrong": 0.01},
  "expected": []
})";

GateFigures figures() {
  GateFigures figures;
  figures.images = 2;
  figures.parts = 20;
  figures.first_pick = 1.0;
  figures.recall = 0.8;
  figures.precision = 0.95;
  figures.average_precision = 0.75;
  figures.brier = 0.05;
  figures.calibration_error = 0.04;
  figures.mean_right = 0.9;
  figures.mean_wrong = 0.3;
  return figures;
}

class ShortChecks : public testing::Test {
 protected:
  ShortChecks() : path_(folder_.write("short.json", kFile)) {
    folder_.write("short.json", recorded(path_, rows(figures())));
    gate_ = readShortGate(path_);
  }

  static std::vector<GateRow> rows(const GateFigures& all) {
    return {{"tof", "bolt", "", "rangepose", figures()}, {"tof", kAllKinds, "", "rangepose", all}};
  }
  /// Keys of the figures of all kinds that fail.
  std::vector<std::string> failures(const GateFigures& now) const {
    std::vector<std::string> keys;
    for (const Movement& one : movements(gate_, rows(now))) {
      if (one.fails) keys.push_back(one.figure);
    }
    return keys;
  }

  test::TempFolder folder_;
  std::filesystem::path path_;
  ShortGate gate_;
};

TEST_F(ShortChecks, WhatWasRecordedPasses) {
  EXPECT_EQ(gate_.expected.size(), 2u);
  EXPECT_TRUE(movements(gate_, rows(figures())).empty());
}

TEST_F(ShortChecks, ALossFailsAndAGainDoesNot) {
  GateFigures now = figures();
  now.recall = 0.76;
  EXPECT_THAT(failures(now), testing::ElementsAre("recall"));
  now.recall = 0.775;
  EXPECT_THAT(failures(now), testing::IsEmpty()) << "within the slack";
  now.recall = 0.99;
  EXPECT_THAT(failures(now), testing::IsEmpty());
  now.first_pick = 0.99;
  EXPECT_THAT(failures(now), testing::ElementsAre("first_pick")) << "no slack is given";
}

TEST_F(ShortChecks, WorseScoresFailByTheBrierScoreAndTheCalibrationError) {
  GateFigures now = figures();
  now.brier = 0.065;
  now.calibration_error = 0.05;
  EXPECT_THAT(failures(now), testing::ElementsAre("brier", "calibration_error"));
  now.brier = 0.01;
  now.calibration_error = 0.0;
  EXPECT_THAT(failures(now), testing::IsEmpty());
}

TEST_F(ShortChecks, MeanScoresMayMoveNeitherWay) {
  for (const double step : {-0.015, 0.015}) {
    GateFigures now = figures();
    now.mean_right += step;
    EXPECT_THAT(failures(now), testing::ElementsAre("mean_right"));
    now = figures();
    now.mean_wrong += step;
    EXPECT_THAT(failures(now), testing::ElementsAre("mean_wrong"));
  }
}

TEST_F(ShortChecks, OtherBinsFail) {
  GateFigures now = figures();
  now.parts = 21;
  EXPECT_THAT(failures(now), testing::ElementsAre("parts"));
}

TEST_F(ShortChecks, AFigureThatIsGoneFails) {
  GateFigures now = figures();
  now.precision = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(failures(now), testing::ElementsAre("precision"));
}

TEST_F(ShortChecks, FiguresOfOneKindAreToldButDoNotFail) {
  std::vector<GateRow> now = rows(figures());
  now[0].figures.recall = 0.5;
  const std::vector<Movement> moved = movements(gate_, now);
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_FALSE(moved[0].fails);
  EXPECT_EQ(movementText(moved), "moved  tof, bolt: recall 0.8 -> 0.5 (slack 0.03)\n");
  now[0].figures.parts = 3;
  EXPECT_THAT(movementText(movements(gate_, now)), testing::HasSubstr("FAILED tof, bolt: parts"));
}

TEST_F(ShortChecks, RowsThatAreNotOnRecordAreAnError) {
  std::vector<GateRow> now = rows(figures());
  now[0].kind = "nuts";
  EXPECT_THROW(movements(gate_, now), Error);
  now = rows(figures());
  now.pop_back();
  EXPECT_THROW(movements(gate_, now), Error) << "else a sensor could be dropped unseen";
}

TEST_F(ShortChecks, RecordingKeepsAllElseAsItIsWritten) {
  const std::string file = kFile;
  const std::string before = file.substr(0, file.find("\"expected\""));
  EXPECT_THAT(recorded(path_, rows(figures())), testing::StartsWith(before));
  EXPECT_EQ(recorded(path_, rows(figures())), recorded(path_, rows(figures())));
  EXPECT_EQ(gate_.slack.at("recall"), 0.03);
  EXPECT_EQ(gate_.slack.at("first_pick"), 0.0);
  EXPECT_EQ(gate_.recipes.sets.front().seed, 8200u);
}

TEST_F(ShortChecks, RecordingRefusesAFileThatItWouldCutOff) {
  folder_.write("short.json", R"({"expected": [], "slack": {}})");
  EXPECT_THROW(recorded(path_, rows(figures())), Error);
}

TEST_F(ShortChecks, UnknownFieldsAreNamed) {
  std::string text = kFile;
  text.replace(text.find("\"brier\""), 7, "\"bier\"");
  folder_.write("short.json", text);
  try {
    readShortGate(path_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("\"bier\" is unknown"));
  }
}

ImageTally imageOf(int scene, bool found) {
  ImageTally tally;
  tally.id = {scene, 0};
  tally.parts = 1;
  tally.first_right = found;
  if (found) tally.shown.push_back({0.9, PoseVerdict::kFound, 0.01});
  tally.checked = tally.shown;
  return tally;
}

TEST(GateRows, SensorsKindsAndPartsAndAllOfThem) {
  BinKind mixed;
  mixed.name = "mixed";
  mixed.parts = {"x/a", "b"};
  BinKind single;
  single.name = "single";
  single.parts = {"b"};
  const CellTallies found{{imageOf(1, true)}, {{imageOf(1, true)}, {imageOf(1, false)}}};
  const CellTallies missed{{imageOf(1, false)}, {}};
  const std::vector<GateCell> cells = {{"tof", mixed, {found}},
                                       {"tof", single, {missed}},
                                       {"laser", mixed, {found}},
                                       {"laser", single, {missed}}};
  const std::vector<GateRow> rows = gateRows(cells, {{"rangepose", "r"}});
  std::vector<std::string> names;
  names.reserve(rows.size());
  for (const GateRow& row : rows) names.push_back(row.sensor + " " + row.kind + " " + row.part);
  EXPECT_THAT(names,
              testing::ElementsAre("tof mixed ",
                                   "tof mixed a",
                                   "tof mixed b",
                                   "tof single ",
                                   "tof all ",
                                   "laser mixed ",
                                   "laser mixed a",
                                   "laser mixed b",
                                   "laser single ",
                                   "laser all ",
                                   "all all "));
  EXPECT_EQ(rows[1].figures.recall, 1.0);
  EXPECT_EQ(rows[2].figures.recall, 0.0);
  EXPECT_EQ(rows[4].figures.recall, 0.5);
  EXPECT_EQ(rows.back().figures.images, 4);
}

TEST(GateRows, OneBinOfSeveralSensorsIsDrawnTogether) {
  BinKind kind;
  kind.name = "k";
  kind.parts = {"a"};
  const auto cellOf = [&](const std::string& sensor) {
    const CellTallies before{{imageOf(1, false), imageOf(2, false)}, {}};
    const CellTallies after{{imageOf(1, true), imageOf(2, false)}, {}};
    return GateCell{sensor, kind, {before, after}};
  };
  const auto rows = differenceRows({cellOf("tof"), cellOf("laser")}, 1);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows.back().sensor, kAllSensors);
  for (const FigureDifference& figure : rows.back().difference.figures) {
    if (std::string(figure.column->key) != "recall") continue;
    EXPECT_EQ(figure.change(), 0.5);
    EXPECT_EQ(figure.interval.low, 0.0) << "one draw in four is the second bin only";
    EXPECT_EQ(figure.interval.high, 1.0);
  }
}

}  // namespace
}  // namespace rangepose::gate
