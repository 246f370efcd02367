// The figures of the gate, against cases worked out by hand. Where one is wrong, users are told
// that a change does them good when it does not.
#include "eval/gate_figures.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "eval/gate_difference.h"
#include "eval/gate_tables.h"
#include "eval/picking_scores.h"

namespace rangepose {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Row {
  double score;
  int truth;  ///< -1: far from all
  double error;
};

ObjectErrors errorsOf(int im_id,
                      int obj_id,
                      const std::vector<double>& visible,
                      const std::vector<Row>& rows) {
  ObjectErrors image;
  image.scene_id = 1;
  image.im_id = im_id;
  image.obj_id = obj_id;
  image.visible_fractions = visible;
  image.mssd = PairErrors(static_cast<int>(visible.size()), static_cast<int>(rows.size()), kFar);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    image.scores.push_back(rows[i].score);
    if (rows[i].truth >= 0) image.mssd.at(rows[i].truth, static_cast<int>(i)) = rows[i].error;
  }
  image.unlike = PairErrors(image.mssd.width(), image.mssd.height(), 1.0);
  image.rotation_rad = image.translation_mm = image.mssd;
  return image;
}

/// Image 1: two parts that must be found and one barely visible; image 2: one part, found twice.
/// Object 9 lies there, too, but is not in the database.
GradedRun twoImages() {
  GradedRun run;
  run.images = {{1, 1}, {1, 2}};
  run.shown = {errorsOf(1, 1, {0.9, 0.8, 0.2}, {{0.95, 0, 0.01}, {0.8, -1, 0.0}, {0.6, 2, 0.03}}),
               errorsOf(1, 9, {0.9, 0.9}, {}),
               errorsOf(2, 1, {1.0}, {{0.92, 0, 0.02}, {0.91, 0, 0.05}})};
  run.checked = run.shown;
  run.checked[0] = errorsOf(
      1, 1, {0.9, 0.8, 0.2}, {{0.95, 0, 0.01}, {0.8, -1, 0.0}, {0.6, 2, 0.03}, {0.1, 1, 0.09}});
  run.times_s = {{{1, 1}, 0.5}, {{1, 2}, 1.5}};
  return run;
}

GateFigures figuresOf(const GradedRun& run, const std::set<int>& objects = {1}) {
  return gateFigures(tallyImages(run, objects));
}

TEST(GateFigures, ByHand) {
  const GateFigures figures = figuresOf(twoImages());
  EXPECT_EQ(figures.images, 2);
  EXPECT_EQ(figures.parts, 3) << "those of object 9 are not missed";
  EXPECT_DOUBLE_EQ(figures.first_pick, 1.0);
  EXPECT_DOUBLE_EQ(figures.recall, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(figures.precision, 2.0 / 4.0) << "two found, two false, one barely visible";
  EXPECT_DOUBLE_EQ(figures.recall_checked, 1.0) << "the second run has the pose of score 0.1";
  EXPECT_EQ(figures.sure, 3);
  EXPECT_DOUBLE_EQ(figures.sure_right, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(figures.median_mssd, 0.02);
  EXPECT_DOUBLE_EQ(figures.time_s, 1.0);
  EXPECT_EQ(figures.none_images, 0);
  EXPECT_TRUE(std::isnan(figures.none_poses));
}

TEST(GateFigures, AveragePrecisionIsThatOfTheSecondRun) {
  // By falling score: found, found, false, false, (barely visible), found.
  EXPECT_DOUBLE_EQ(figuresOf(twoImages()).average_precision, (1.0 + 1.0 + 3.0 / 5.0) / 3.0);
}

TEST(GateFigures, ScoresAsProbabilities) {
  const GateFigures figures = figuresOf(twoImages());
  EXPECT_EQ(figures.checked, 6);
  const double squares =
      0.05 * 0.05 + 0.8 * 0.8 + 0.4 * 0.4 + 0.9 * 0.9 + 0.08 * 0.08 + 0.91 * 0.91;
  EXPECT_DOUBLE_EQ(figures.brier, squares / 6.0);
  // Tenths: 0.1 (one, right), 0.6 (one, right), 0.8 (one, wrong), 0.9 (three, two right).
  const double top = std::abs((0.95 + 0.92 + 0.91) / 3.0 - 2.0 / 3.0);
  EXPECT_NEAR(figures.calibration_error, (0.9 + 0.4 + 0.8 + 3.0 * top) / 6.0, 1e-12);
  EXPECT_DOUBLE_EQ(figures.mean_right, (0.95 + 0.6 + 0.1 + 0.92) / 4.0);
  EXPECT_DOUBLE_EQ(figures.mean_wrong, (0.8 + 0.91) / 2.0);
  ASSERT_EQ(figures.reliability.size(), 10u);
  EXPECT_EQ(figures.reliability[9].count, 3);
}

TEST(GateFigures, ScoresThatAreNoProbabilitiesHaveNoCalibration) {
  GradedRun run = twoImages();
  run.checked[2].scores[0] = 7.0;
  const GateFigures figures = figuresOf(run);
  EXPECT_TRUE(std::isnan(figures.brier));
  EXPECT_TRUE(std::isnan(figures.calibration_error));
  EXPECT_FALSE(std::isnan(figures.average_precision));
}

TEST(GateFigures, PosesWhereNoPartLiesAreWrong) {
  GradedRun run;
  run.images = {{1, 1}, {1, 2}, {1, 3}, {1, 4}};
  run.shown = wrongPoses({{1, 1, 1, 0.6, {}, 2.0}, {1, 1, 1, 0.95, {}, 2.0}, {1, 3, 1, 0.7, {}}});
  ASSERT_EQ(run.shown.size(), 2u);
  EXPECT_THAT(run.shown[0].scores, testing::ElementsAre(0.95, 0.6)) << "by falling score";
  run.shown.push_back(errorsOf(4, 1, {0.3}, {{0.9, 0, 0.01}}));
  run.checked = run.shown;
  const GateFigures figures = figuresOf(run);
  EXPECT_EQ(figures.images, 4);
  EXPECT_EQ(figures.none_images, 3) << "image 4 holds a part, if barely visible";
  EXPECT_DOUBLE_EQ(figures.none_poses, 1.0);
  EXPECT_DOUBLE_EQ(figures.precision, 0.0);
  EXPECT_TRUE(std::isnan(figures.recall));
  EXPECT_TRUE(std::isnan(figures.first_pick));
  EXPECT_TRUE(std::isnan(figures.average_precision));
  EXPECT_DOUBLE_EQ(figures.sure_right, 0.0);
  EXPECT_DOUBLE_EQ(figures.mean_wrong, (0.6 + 0.95 + 0.7) / 3.0);
}

TEST(GateFigures, AgreeWithThoseOfEvaluate) {
  const GradedRun run = twoImages();
  const PickingScores shown = pickingScores(run.shown, {}, 1);
  const PickingScores checked = pickingScores(run.checked, {}, 1);
  const GateFigures figures = figuresOf(run);
  EXPECT_EQ(figures.parts, shown.parts);
  EXPECT_EQ(figures.recall, shown.recall);
  EXPECT_EQ(figures.precision, shown.precision);
  EXPECT_EQ(figures.recall_as_seen, shown.recall_as_seen);
  EXPECT_EQ(figures.precision_as_seen, shown.precision_as_seen);
  EXPECT_EQ(figures.first_pick, shown.first_pick);
  EXPECT_EQ(figures.median_mssd, shown.median_mssd);
  EXPECT_EQ(figures.average_precision, checked.average_precision);
  EXPECT_EQ(figures.recall_checked, checked.recall);
}

TEST(GateFigures, AsSeenAPoseThatLooksRightIsRight) {
  GradedRun run = twoImages();
  run.shown[0].unlike.at(1, 1) = 0.0;
  const GateFigures figures = figuresOf(run);
  EXPECT_DOUBLE_EQ(figures.recall_as_seen, 1.0);
  EXPECT_DOUBLE_EQ(figures.precision_as_seen, 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(figures.recall, 2.0 / 3.0);
}

TEST(GateFigures, OnePartOfSeveral) {
  GradedRun run = twoImages();
  const GateFigures figures = figuresOf(run, {9});
  EXPECT_EQ(figures.parts, 2);
  EXPECT_EQ(figures.none_images, 1) << "image 2";
  EXPECT_DOUBLE_EQ(figures.recall, 0.0);
  EXPECT_DOUBLE_EQ(figures.first_pick, 0.0);
}

TEST(GateTables, NothingToCountIsADash) {
  const GateRow row{"tof", "dowels only", "", "rangepose", figuresOf({{{1, 1}}, {}, {}, {}})};
  EXPECT_THAT(gateMarkdown({row}),
              testing::HasSubstr("| tof | dowels only |  | rangepose | 1 | 0 | - |"));
  EXPECT_THAT(gateCsv({row}), testing::HasSubstr("\ntof,dowels only,,rangepose,1,0,,,"));
}

TEST(GateTables, CalibrationIsOfAllKindsTogether) {
  const GateFigures figures = figuresOf(twoImages());
  const std::string text = calibrationMarkdown({{"tof", "cups", "", "A", figures},
                                                {"tof", kAllKinds, "cup", "A", figures},
                                                {"tof", kAllKinds, "", "B", figures}});
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("| A |")));
  EXPECT_THAT(text, testing::HasSubstr("| tof | B | 0.9 to 1.0 | 3 | 0.927 | 66.7 |"));
}

/// Images of one part each: found or missed.
std::vector<ImageTally> foundOf(const std::vector<bool>& found) {
  std::vector<ImageTally> tallies;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ImageTally tally;
    tally.id = {1, static_cast<int>(i)};
    tally.parts = 1;
    tally.first_right = found[i];
    if (found[i]) tally.shown.push_back({0.9, PoseVerdict::kFound, 0.01});
    tally.checked = tally.shown;
    tally.time_s = 2.0;
    tallies.push_back(tally);
  }
  return tallies;
}

PairedTallies pairsOf(const std::vector<ImageTally>& before, const std::vector<ImageTally>& after) {
  PairedTallies pairs;
  for (std::size_t i = 0; i < before.size(); ++i) {
    pairs.before.push_back(&before[i]);
    pairs.after.push_back(&after[i]);
    pairs.units.push_back(i);
  }
  return pairs;
}

const FigureDifference& of(const GateDifference& difference, const std::string& key) {
  for (const FigureDifference& figure : difference.figures) {
    if (key == figure.column->key) return figure;
  }
  throw Error("no difference of " + key);
}

TEST(GateDifference, ImagesArePaired) {
  // Half of the parts are found by both, and always the same ones: no draw shows a difference,
  // though each figure by itself varies.
  std::vector<bool> found;
  for (int i = 0; i < 40; ++i) found.push_back(i % 2 == 0);
  const std::vector<ImageTally> tallies = foundOf(found);
  const GateDifference same = gateDifference(pairsOf(tallies, tallies));
  EXPECT_EQ(of(same, "recall").interval.low, 0.0);
  EXPECT_EQ(of(same, "recall").interval.high, 0.0);
  EXPECT_FALSE(of(same, "recall").clear());
  EXPECT_EQ(same.time_ratio, 1.0);
}

TEST(GateDifference, ClearWhereManyImagesGainAndNotWhereOneDoes) {
  const std::vector<ImageTally> none = foundOf(std::vector<bool>(40, false));
  std::vector<bool> found(40, false);
  found[3] = true;
  const std::vector<ImageTally> one = foundOf(found);
  for (std::size_t i = 0; i < 20; ++i) found[i] = true;
  const std::vector<ImageTally> many = foundOf(found);
  EXPECT_FALSE(of(gateDifference(pairsOf(none, one)), "recall").clear());
  const GateDifference gain = gateDifference(pairsOf(none, many));
  EXPECT_TRUE(of(gain, "recall").clear());
  EXPECT_DOUBLE_EQ(of(gain, "recall").change(), 0.5);
  // Of 40 draws with chance 1/2 the deviation is 0.079.
  EXPECT_NEAR(of(gain, "recall").interval.low, 0.5 - 1.96 * 0.079, 0.03);
  EXPECT_NEAR(of(gain, "recall").interval.high, 0.5 + 1.96 * 0.079, 0.03);
  EXPECT_THAT(differenceMarkdown({{"tof", "cup", gain}}), testing::HasSubstr("| +50.0 (+"));
  EXPECT_TRUE(of(gateDifference(pairsOf(many, none)), "recall").clear()) << "a loss, too";
}

TEST(GateDifference, ImagesOfOneBinAreDrawnTogether) {
  std::vector<bool> found(40, false);
  for (std::size_t i = 0; i < 20; ++i) found[i] = true;
  const std::vector<ImageTally> none = foundOf(std::vector<bool>(40, false));
  const std::vector<ImageTally> half = foundOf(found);
  PairedTallies pairs = pairsOf(none, half);
  for (std::size_t i = 0; i < pairs.units.size(); ++i) pairs.units[i] = i / 20;
  const FigureDifference recall = of(gateDifference(pairs), "recall");
  EXPECT_EQ(recall.interval.low, 0.0) << "both draws are the second bin: one in four";
  EXPECT_EQ(recall.interval.high, 1.0);
}

TEST(GateDifference, FewBinsAreNeverClear) {
  const auto recallOf = [](std::size_t bins) {
    const std::vector<ImageTally> none = foundOf(std::vector<bool>(bins, false));
    const std::vector<ImageTally> all = foundOf(std::vector<bool>(bins, true));
    return of(gateDifference(pairsOf(none, all)), "recall");
  };
  EXPECT_EQ(recallOf(5).interval.low, 1.0);
  EXPECT_FALSE(recallOf(5).clear()) << "five coins show the same side in one of 16 throws";
  EXPECT_TRUE(recallOf(6).clear());
}

TEST(GateDifference, OtherImagesAreRefused) {
  std::vector<ImageTally> before = foundOf({true, false});
  std::vector<ImageTally> after = before;
  after[1].id = {2, 7};
  EXPECT_THROW(gateDifference(pairsOf(before, after)), Error);
  EXPECT_THROW(gateDifference({}), Error);
}

TEST(GateColumns, KeysAreUniqueAndUnknownOnesAreNamed) {
  std::set<std::string> keys;
  for (const GateColumn& column : gateColumns()) EXPECT_TRUE(keys.insert(column.key).second);
  EXPECT_STREQ(gateColumn("recall").title, "recall [%]");
  EXPECT_THROW(gateColumn("recal"), Error);
}

}  // namespace
}  // namespace rangepose
