// BOP's average recalls and the bin-picking figures, against cases worked out by hand.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "eval/bop_scores.h"
#include "eval/picking_scores.h"

namespace rangepose {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// An image in which estimate i has the error `errors[i]` against truth `truths[i]` (-1: against
/// all of them far).
struct Row {
  double score;
  int truth;
  double error;
};

ObjectErrors imageOf(int im_id,
                     const std::vector<double>& visible,
                     const std::vector<Row>& rows,
                     int obj_id = 1) {
  ObjectErrors image;
  image.scene_id = 1;
  image.im_id = im_id;
  image.obj_id = obj_id;
  image.visible_fractions = visible;
  for (const double fraction : visible) image.targets += fraction >= 0.1 ? 1 : 0;
  image.mssd = PairErrors(static_cast<int>(visible.size()), static_cast<int>(rows.size()), kFar);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    image.scores.push_back(rows[i].score);
    if (rows[i].truth >= 0) image.mssd.at(rows[i].truth, static_cast<int>(i)) = rows[i].error;
  }
  image.mspd_px = image.mssd;
  for (double& value : image.mspd_px) value *= 100.0;
  image.vsd.assign(10, image.mssd);
  image.unlike = PairErrors(image.mssd.width(), image.mssd.height(), 1.0);
  image.rotation_rad = image.translation_mm = image.mssd;
  return image;
}

TEST(BopScores, TruthAsEstimateIsExactlyOne) {
  const BopScores scores =
      bopScores({imageOf(1, {0.9, 0.3}, {{0.9, 0, 0.0}, {0.8, 1, 0.0}}), imageOf(2, {}, {})});
  EXPECT_EQ(scores.vsd, 1.0);
  EXPECT_EQ(scores.mssd, 1.0);
  EXPECT_EQ(scores.mspd, 1.0);
  EXPECT_EQ(scores.average(), 1.0);
  EXPECT_EQ(scores.targets, 2);
}

TEST(BopScores, MeanOverTheThresholds) {
  // 0.12 is right from 0.15 on: 8 of 10 thresholds. One of two targets.
  const BopScores scores = bopScores({imageOf(1, {0.9, 0.9}, {{0.9, 0, 0.12}})});
  EXPECT_DOUBLE_EQ(scores.mssd, 0.4);
  EXPECT_DOUBLE_EQ(scores.mspd, 0.4) << "12 px: from 15 px on";
  EXPECT_DOUBLE_EQ(scores.vsd, 0.4);
}

TEST(BopScores, OnlyAsManyEstimatesAsTargetsAndOnlyTheMostVisibleTruths) {
  // The second estimate is right but comes third: two targets, so it does not count.
  const BopScores late =
      bopScores({imageOf(1, {0.9, 0.8, 0.05}, {{0.9, 0, 0.0}, {0.8, -1, 0.0}, {0.7, 1, 0.0}})});
  EXPECT_DOUBLE_EQ(late.mssd, 0.5);
  // Right on a part that is no target.
  const BopScores hidden = bopScores({imageOf(1, {0.9, 0.05}, {{0.9, 1, 0.0}})});
  EXPECT_DOUBLE_EQ(hidden.mssd, 0.0);
  EXPECT_TRUE(std::isnan(bopScores({imageOf(1, {0.05}, {{0.9, 0, 0.0}})}).mssd)) << "no target";
}

TEST(BopScores, OfOneObject) {
  const std::vector<ObjectErrors> images = {imageOf(1, {0.9}, {{0.9, 0, 0.0}}, 1),
                                            imageOf(1, {0.9}, {{0.9, -1, 0.0}}, 2)};
  EXPECT_EQ(bopScores(images, 1).mssd, 1.0);
  EXPECT_EQ(bopScores(images, 2).mssd, 0.0);
  EXPECT_EQ(bopScores(images).mssd, 0.5);
}

TEST(PickingScores, PerfectResult) {
  const std::vector<ObjectErrors> images = {imageOf(1, {0.9, 0.6}, {{0.9, 0, 0.0}, {0.8, 1, 0.0}}),
                                            imageOf(2, {1.0}, {{0.7, 0, 0.0}})};
  const PickingScores scores = pickingScores(images, {});
  EXPECT_EQ(scores.images, 2);
  EXPECT_EQ(scores.parts, 3);
  for (const double one : {scores.first_pick,
                           scores.first_pick_strict,
                           scores.recall,
                           scores.recall_strict,
                           scores.precision,
                           scores.average_precision,
                           scores.recall_at_99}) {
    EXPECT_EQ(one, 1.0);
  }
  EXPECT_EQ(scores.median_mssd, 0.0);
  EXPECT_EQ(recallAt(images, 1e-9, 0.5), 1.0);
}

TEST(PickingScores, AsSeenAPoseThatLooksLikeTheTrueOneIsRight) {
  std::vector<ObjectErrors> images = {
      imageOf(1, {0.9, 0.8, 0.7}, {{0.9, 0, 0.01}, {0.8, 1, 0.4}, {0.7, 2, 0.4}})};
  images[0].unlike.at(1, 1) = 0.001;  // the wrong way up, which the image does not show
  images[0].unlike.at(2, 2) = 0.02;   // which it shows
  const PickingScores scores = pickingScores(images, {});
  EXPECT_DOUBLE_EQ(scores.recall, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.precision, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.recall_as_seen, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.precision_as_seen, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.median_mssd, 0.01) << "errors are those of right poses";
}

TEST(PickingScores, AsSeenEachPartIsFoundOnce) {
  std::vector<ObjectErrors> images = {imageOf(1, {0.9}, {{0.9, 0, 0.4}, {0.8, 0, 0.01}})};
  images[0].unlike.at(0, 0) = images[0].unlike.at(0, 1) = 0.0;
  const PickingScores scores = pickingScores(images, {});
  EXPECT_DOUBLE_EQ(scores.recall_as_seen, 1.0);
  EXPECT_DOUBLE_EQ(scores.precision_as_seen, 0.5) << "both poses of a part are two answers";
}

/// By falling score: found, false, found, ignored (visible 0.3), a second time the first part
/// (false), found. Four parts to find.
std::vector<ObjectErrors> mixedImage() {
  return {imageOf(1,
                  {0.9, 0.8, 0.3, 0.7, 0.6},
                  {{0.95, 0, 0.01},
                   {0.9, -1, 0.0},
                   {0.8, 1, 0.05},
                   {0.7, 2, 0.02},
                   {0.6, 0, 0.015},
                   {0.4, 3, 0.09}})};
}

TEST(PickingScores, ByHand) {
  const PickingScores scores = pickingScores(mixedImage(), {});
  EXPECT_EQ(scores.parts, 4);
  EXPECT_EQ(scores.estimates, 6);
  EXPECT_EQ(scores.ignored, 1);
  EXPECT_DOUBLE_EQ(scores.recall, 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(scores.recall_strict, 1.0 / 4.0);
  EXPECT_DOUBLE_EQ(scores.precision, 3.0 / 5.0);
  // Recall 1/4 at precision 1, 2/4 at 2/3, 3/4 at 3/5.
  EXPECT_DOUBLE_EQ(scores.average_precision, 0.25 * (1.0 + 2.0 / 3.0 + 3.0 / 5.0));
  EXPECT_DOUBLE_EQ(scores.recall_at_99, 0.25);
  EXPECT_DOUBLE_EQ(scores.first_pick, 1.0);
  EXPECT_DOUBLE_EQ(scores.first_pick_strict, 1.0);
  EXPECT_DOUBLE_EQ(scores.median_mssd, 0.5 * (0.02 + 0.05)) << "0.01 0.02 0.05 0.09";
  EXPECT_DOUBLE_EQ(recallAt(mixedImage(), 0.06, 0.5), 0.5);
}

TEST(PickingScores, PrecisionCountsFromTheLargestRecallThatReachesIt) {
  // false, found, found: precision 0, 1/2, 2/3; the best further right counts.
  const PickingScores scores =
      pickingScores({imageOf(1, {0.9, 0.8}, {{0.9, -1, 0.0}, {0.8, 0, 0.0}, {0.7, 1, 0.0}})}, {});
  EXPECT_DOUBLE_EQ(scores.average_precision, 2.0 / 3.0);
  EXPECT_EQ(scores.recall_at_99, 0.0);
  EXPECT_EQ(scores.first_pick, 0.0);
}

TEST(PickingScores, EqualScoresCountTogether) {
  for (const bool right_first : {false, true}) {
    const PickingScores scores =
        pickingScores({imageOf(1, {0.9}, {{0.5, right_first ? 0 : -1, 0.0}}),
                       imageOf(2, {0.9}, {{0.5, right_first ? -1 : 0, 0.0}})},
                      {});
    ASSERT_EQ(scores.curve.size(), 1u);
    EXPECT_DOUBLE_EQ(scores.average_precision, 0.25) << "precision 1/2 at recall 1/2";
  }
}

TEST(PickingScores, FirstPickIsTheTopOfAllObjects) {
  const std::vector<ObjectErrors> images = {imageOf(1, {0.9}, {{0.6, 0, 0.0}}, 1),
                                            imageOf(1, {0.9}, {{0.7, 0, 0.05}}, 2),
                                            imageOf(2, {0.9}, {}, 1),
                                            imageOf(3, {0.3}, {{0.9, -1, 0.0}}, 1)};
  const PickingScores all = pickingScores(images, {});
  EXPECT_EQ(all.images, 2) << "image 3 has no part that must be found";
  EXPECT_DOUBLE_EQ(all.first_pick, 0.5) << "image 2 has no estimate";
  EXPECT_DOUBLE_EQ(all.first_pick_strict, 0.0) << "object 2 is surer";
  EXPECT_DOUBLE_EQ(pickingScores(images, {}, 1).first_pick_strict, 0.5);
  EXPECT_DOUBLE_EQ(all.precision, 2.0 / 3.0);
}

TEST(PickingScores, NothingToCountIsNotANumber) {
  const PickingScores none = pickingScores({imageOf(1, {}, {})}, {});
  EXPECT_TRUE(std::isnan(none.recall));
  EXPECT_TRUE(std::isnan(none.precision));
  EXPECT_TRUE(std::isnan(none.first_pick));
  EXPECT_TRUE(std::isnan(none.average_precision));
  const PickingScores missed = pickingScores({imageOf(1, {0.9}, {})}, {});
  EXPECT_EQ(missed.recall, 0.0);
  EXPECT_EQ(missed.average_precision, 0.0);
  EXPECT_EQ(missed.first_pick, 0.0);
}

TEST(PickingScores, ReliabilityBins) {
  const PickingScores scores = pickingScores(mixedImage(), {});
  ASSERT_EQ(scores.reliability.size(), 10u);
  EXPECT_EQ(scores.reliability[9].count, 2);
  EXPECT_DOUBLE_EQ(scores.reliability[9].mean_score, 0.925);
  EXPECT_DOUBLE_EQ(scores.reliability[9].right, 0.5);
  EXPECT_DOUBLE_EQ(scores.reliability[7].right, 1.0) << "barely visible, yet right";
  EXPECT_DOUBLE_EQ(scores.reliability[6].right, 0.0) << "a part found twice";
  EXPECT_EQ(scores.reliability[0].count, 0);
  EXPECT_TRUE(pickingScores({imageOf(1, {0.9}, {{7.0, 0, 0.0}})}, {}).reliability.empty());
}

TEST(PickingScores, OptionsAreChecked) {
  PickingOptions options;
  options.right = 0.6;
  EXPECT_THROW(pickingScores({}, options), Error);
  options = {};
  options.strict = 0.2;
  EXPECT_THROW(pickingScores({}, options), Error);
  options = {};
  options.min_visible = 1.5;
  EXPECT_THROW(pickingScores({}, options), Error);
}

}  // namespace
}  // namespace rangepose
