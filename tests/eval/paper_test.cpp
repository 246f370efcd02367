// The paper's experiment: its figures, our summaries, tables and pictures.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "eval/ablation.h"
#include "eval/contact_sheet.h"
#include "eval/failure_pictures.h"
#include "eval/paper_plots.h"
#include "eval/paper_tables.h"
#include "eval/stacked_bars.h"
#include "io/io_support.h"
#include "support/box_mesh.h"

namespace rangepose {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<PaperSetting> kPaperSettings = {{"uniform", 32, 1024},
                                                  {"uniform", 64, 1024},
                                                  {"adaptive", 32, 1024},
                                                  {"adaptive", 64, 1024},
                                                  {"adaptive", 32, 2048},
                                                  {"adaptive", 64, 2048}};

TEST(PaperFigures, SumsAndMeansFit) {
  for (const PaperSetting& setting : kPaperSettings) {
    int correct = 0;
    for (const char* model : {"t_pipe", "bolt", "elbow"}) {
      const auto rough = paperRough(setting, model);
      ASSERT_TRUE(rough) << model;
      correct += rough->correct;
    }
    const int all = paperRough(setting, "all")->correct;
    EXPECT_NEAR(all, correct, 1) << "the paper's own sum is off by one for uniform 32";
  }
  EXPECT_EQ(paperRough({"adaptive", 64, 1024}, "all")->correct, 203);
  EXPECT_EQ(paperRough({"adaptive", 64, 1024}, "all")->errors.vertex_percent, 4.91);
  EXPECT_EQ(paperFine({"adaptive", 64, 1024}, "all")->vertex_percent, 0.68);
  EXPECT_EQ(paperFine({"adaptive", 64, 2048}, "all")->vertex_percent, 0.11);
  EXPECT_EQ(paperMemoryMb({"adaptive", 64, 2048}, "elbow"), 160.80);
  EXPECT_EQ(paperRoughSeconds({"uniform", 64, 1024}, "all"), 0.43);
}

TEST(PaperFigures, NothingIsInvented) {
  EXPECT_FALSE(paperRough({"uniform", 64, 2048}, "all"));
  EXPECT_FALSE(paperRough({"adaptive", 48, 1024}, "all"));
  EXPECT_FALSE(paperRough({"adaptive", 64, 1000}, "all"));
  EXPECT_FALSE(paperRough({"adaptive", 64, 1024}, "bracket"));
  EXPECT_FALSE(paperFine({"uniform", 64, 1024}, "bolt"));
  EXPECT_FALSE(paperMemoryMb({"adaptive", 64, 1024}, "all"));
  EXPECT_FALSE(paperFineSeconds({"adaptive", 16, 1024}, "bolt"));
}

Trial trialOf(bool right, double vertex, double degrees) {
  Trial trial;
  trial.fine.part = 0;
  trial.fine.right = right;
  trial.fine.vertex = vertex;
  trial.fine.rotation_rad = degrees * std::acos(-1.0) / 180.0;
  trial.fine.euler_rad = glm::dvec3(trial.fine.rotation_rad, 0.0, 0.0);
  trial.fine.center = 0.5;
  trial.rough = trial.fine;
  trial.unlimited = trial.fine;
  trial.unlimited.vertex *= 2.0;
  trial.visible = 0.9;
  return trial;
}

SettingRun smallRun() {
  SettingRun run{{"adaptive", 64, 1024}, {}};
  run.models = {{"t_pipe", {trialOf(true, 0.01, 2.0), trialOf(true, 0.03, 4.0)}, 67.1},
                {"bolt", {trialOf(false, 0.4, 90.0)}, 67.1}};
  run.models[0].trials[1].times = {{"rough search", 30.0}, {"fine icp and check", 10.0}};
  run.models[1].trials[0].times = {{"rough search", 50.0}, {"fine icp and check", 20.0}};
  return run;
}

TEST(PaperTables, MeansAreOverTheRightOnes) {
  const GradeSummary summary = summarize(allTrials(smallRun()), &Trial::fine);
  EXPECT_EQ(summary.trials, 3);
  EXPECT_EQ(summary.right, 2);
  EXPECT_NEAR(summary.vertex_percent, 2.0, 1e-12);
  EXPECT_NEAR(summary.rotation_deg, 3.0, 1e-12);
  EXPECT_NEAR(summary.euler_deg.x, 3.0, 1e-12);
  const GradeSummary none = summarize(allTrials(smallRun()), &Trial::search);
  EXPECT_EQ(none.right, 0);
  EXPECT_TRUE(std::isnan(none.vertex_percent));
  const StageTimes times = meanTimes(allTrials(smallRun()));
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].ms, 40.0);
  EXPECT_EQ(times[1].ms, 15.0);
}

TEST(PaperTables, OursBesideThePapers) {
  const std::string text = paperMarkdown({smallRun()});
  EXPECT_THAT(
      text,
      AllOf(
          HasSubstr("| t_pipe (2) | adaptive | 64 | 1024 | 56 | 5.11 | 6.56 5.73 3.06 | 2 (100.0 "
                    "%) | 4.00 | 3.00 0.00 0.00 | 0 (0.0 %) | - | - | 2 (100.0 %) | 2.00 | 3.00 "
                    "0.00 0.00 |"),
          HasSubstr("| all (3) | adaptive | 64 | 1024 | 203 | 4.91 |"),
          HasSubstr("| all (3) | adaptive | 64 | 1024 | 0.68 | 0.31 0.35 0.59 | 2 (66.7 %) | 2.000 "
                    "| 3.00 0.00 0.00 | 3.000 |"),
          HasSubstr("| bolt | adaptive | 64 | 1024 | 50.13 | 67.10 |"),
          HasSubstr("| all | adaptive | 64 | 1024 | 0.43 | 0.02 | 0.040 | 0.015 | 0.055 |")));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(PaperTables, CsvHasALineForEachTrial) {
  const std::string text = trialsCsv({smallRun(), smallRun()});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7);
  const auto columns = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  std::istringstream lines(text);
  std::string header;
  std::getline(lines, header);
  for (std::string line; std::getline(lines, line);) EXPECT_EQ(columns(line), columns(header));
}

TEST(FailurePictures, CausesFollowTheFigures) {
  Trial trial = trialOf(false, 0.4, 120.0);
  EXPECT_THAT(likelyCause(trial), HasSubstr("across several parts, 50 %"));
  trial.fine.center = 0.02;
  EXPECT_THAT(likelyCause(trial), HasSubstr("turned by 120 degrees"));
  trial.visible = 0.1;
  EXPECT_THAT(likelyCause(trial), HasSubstr("10 % are visible"));
  trial.fine.part = -1;
  EXPECT_THAT(likelyCause(trial), HasSubstr("no hypothesis"));
}

/// One bracket in a bin, and an answer that is right or wrong.
class PaperPictures : public testing::Test {
 protected:
  PaperPictures() {
    bin_.mesh = &mesh_;
    bin_.inner_mm = {100.0, 80.0, 50.0};
    Pose pose;
    pose.translation_mm = {-20.0, -6.0, 0.0};
    bin_.bin_from_object = {pose};
  }
  void run(double shift_mm, const TrialObserver& observe) const {
    emptyBin(
        bin_,
        ErrorModel(mesh_, {}),
        {},
        [shift_mm](const BinScan& scan) {
          TrialAnswer answer;
          answer.fine = scan.truth.front();
          answer.fine->translation_mm.x += shift_mm;
          answer.score = 0.75;
          return answer;
        },
        observe);
  }
  const Mesh mesh_ = test::meshOf(test::bracketBoxes());
  VirtualBin bin_;
  const test::TempFolder folder_;
};

TEST_F(PaperPictures, OnlyFailuresAreDrawn) {
  FailurePictures pictures(folder_.path());
  for (const double shift_mm : {0.0, 30.0}) {
    run(shift_mm, [&](const Trial& trial, const BinScan& scan, const TrialAnswer& answer) {
      pictures.add({"adaptive", 64, 1024}, "bracket", mesh_, trial, scan, answer);
    });
  }
  EXPECT_EQ(pictures.count(), 1);
  const std::string name = "adaptive_64_1024_bracket_bin0_trial1.png";
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / name));
  EXPECT_THAT(pictures.markdown(),
              AllOf(HasSubstr("1 failed trials"), HasSubstr(name), HasSubstr("score 0.75")));
}

TEST_F(PaperPictures, ContactSheetMarksThePart) {
  const auto greenAndRed = [this](double shift_mm) {
    ContactSheet sheet(mesh_, "one bracket");
    EXPECT_TRUE(sheet.empty());
    run(shift_mm, [&sheet](const Trial& trial, const BinScan& scan, const TrialAnswer& answer) {
      sheet.add(trial, scan, answer);
    });
    const cv::Mat picture = sheet.picture();
    // The depth map to the right has colours of its own.
    const cv::Mat left = picture.colRange(0, 200);
    int green = 0;
    int red = 0;
    for (int y = 0; y < left.rows; ++y) {
      for (int x = 0; x < left.cols; ++x) {
        const auto& pixel = left.at<cv::Vec3b>(y, x);
        green += pixel[1] > pixel[2] + 40 && pixel[1] > pixel[0] + 40 ? 1 : 0;
        red += pixel[2] > pixel[1] + 40 ? 1 : 0;
      }
    }
    return std::pair(green, red);
  };
  const auto [green, no_red] = greenAndRed(0.0);
  EXPECT_GT(green, 1000);
  EXPECT_EQ(no_red, 0);
  const auto [no_green, red] = greenAndRed(10.0);
  EXPECT_EQ(no_green, 0);
  EXPECT_GT(red, 1000);
}

TEST_F(PaperPictures, PlotsAreWritten) {
  writePaperPlots(folder_.path(), {smallRun()});
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "times.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "success.png"));
}

TEST(StackedBars, LengthsFollowTheValues) {
  StackedBars chart;
  chart.parts = {"a", "b"};
  chart.bars = {{"long", {60.0, 40.0}}, {"short", {10.0, 0.0}}};
  const cv::Mat picture = drawStackedBars(chart);
  int coloured[2] = {0, 0};
  const auto count = [&picture](int y) {
    int pixels = 0;
    // Left of the legend, which has the colours, too.
    for (int x = 0; x < 1000; ++x) {
      const auto& pixel = picture.at<cv::Vec3b>(y, x);
      pixels += std::abs(pixel[0] - pixel[2]) > 60 ? 1 : 0;
    }
    return pixels;
  };
  for (int y = 0; y < picture.rows; ++y) {
    const int pixels = count(y);
    if (pixels > 500) ++coloured[0];
    if (pixels > 40 && pixels < 80) ++coloured[1];
  }
  EXPECT_GT(coloured[0], 20);
  EXPECT_GT(coloured[1], 20);
  chart.bars[0].values.pop_back();
  EXPECT_THROW(drawStackedBars(chart), Error);
}

TEST(Ablation, EachRowChangesSomethingElse) {
  std::set<std::string> names;
  for (const AblationRow& row : ablationRows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EstimateOptions options;
    row.change(options);
    EXPECT_NO_THROW(options.check());
  }
  EXPECT_EQ(ablationRows().front().name, "as released");
  EXPECT_GT(names.size(), 15u);
}

}  // namespace
}  // namespace rangepose
