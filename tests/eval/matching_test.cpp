#include "eval/matching.h"

#include <gmock/gmock.h>

#include <vector>

namespace rangepose {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Rows are estimates, columns true poses.
PairErrors table(const std::vector<std::vector<double>>& rows) {
  PairErrors errors(rows.empty() ? 0 : static_cast<int>(rows[0].size()),
                    static_cast<int>(rows.size()));
  for (int y = 0; y < errors.height(); ++y) {
    for (int x = 0; x < errors.width(); ++x) {
      errors.at(x, y) = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
    }
  }
  return errors;
}

TEST(Matching, TheSurerEstimateTakesTheTruthThoughAnotherIsCloser) {
  EXPECT_THAT(matchGreedily(table({{0.09, 0.5}, {0.01, 0.5}}), 0.1), ElementsAre(0, kUnmatched));
}

TEST(Matching, EachTruthIsTakenOnceAndTheClosestFreeOneFirst) {
  EXPECT_THAT(matchGreedily(table({{0.05, 0.02}, {0.01, 0.03}, {0.04, 0.04}}), 0.1),
              ElementsAre(1, 0, kUnmatched));
}

TEST(Matching, TheThresholdItselfIsTooMuch) {
  EXPECT_THAT(matchGreedily(table({{0.1}, {0.0999}}), 0.1), ElementsAre(kUnmatched, 0));
}

TEST(Matching, OnlyEligibleTruthsAndTheFirstEstimates) {
  const PairErrors errors = table({{0.01, 0.05}, {0.01, 0.05}, {0.01, 0.05}});
  EXPECT_THAT(matchGreedily(errors, 0.1, {false, true}), ElementsAre(1, kUnmatched, kUnmatched));
  EXPECT_THAT(matchGreedily(errors, 0.1, {}, 1), ElementsAre(0, kUnmatched, kUnmatched));
  EXPECT_THAT(matchGreedily(errors, 0.1, {}, 9), ElementsAre(0, 1, kUnmatched));
  EXPECT_THROW(matchGreedily(errors, 0.1, {true}), Error);
}

TEST(Matching, NothingThere) {
  EXPECT_THAT(matchGreedily(PairErrors(3, 0), 0.1), IsEmpty());
  EXPECT_THAT(matchGreedily(PairErrors(0, 2), 0.1), ElementsAre(kUnmatched, kUnmatched));
}

TEST(Matching, LargestFlagsTheFirstOfEqualOnes) {
  EXPECT_THAT(largest({0.5, 0.9, 0.5, 0.5}, 3), ElementsAre(true, true, true, false));
  EXPECT_THAT(largest({0.5, 0.9}, 5), ElementsAre(true, true));
  EXPECT_THAT(largest({0.5, 0.9}, 0), ElementsAre(false, false));
}

}  // namespace
}  // namespace rangepose
