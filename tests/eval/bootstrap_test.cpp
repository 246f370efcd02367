// Intervals of figures by drawing images anew. Where they are too narrow, chance is taken for the
// effect of a change.
#include "eval/bootstrap.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/random.h"

namespace rangepose {
namespace {

/// The mean of the drawn ones of these values.
FiguresOfDraw meanOf(const std::vector<double>& values) {
  return [values](const std::vector<std::size_t>& drawn) {
    double sum = 0.0;
    for (const std::size_t i : drawn) sum += values[i];
    return std::vector<double>{sum / static_cast<double>(drawn.size())};
  };
}

std::vector<double> normalValues(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(random.normal());
  return values;
}

TEST(Bootstrap, IntervalOfAMeanIsThatOfItsStandardError) {
  const std::vector<double> values = normalValues(3, 400);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 400.0;
  const Interval interval = bootstrapIntervals(values.size(), meanOf(values)).at(0);
  EXPECT_NEAR(interval.low, mean - 1.96 / 20.0, 0.015);
  EXPECT_NEAR(interval.high, mean + 1.96 / 20.0, 0.015);
}

TEST(Bootstrap, HoldsTheTrueMeanAboutAsOftenAsItSays) {
  int held = 0;
  constexpr int kTrials = 200;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const std::vector<double> values = normalValues(100 + trial, 40);
    BootstrapOptions options;
    options.draws = 300;
    options.seed = trial;
    held += bootstrapIntervals(values.size(), meanOf(values), options)[0].leavesOut(0.0) ? 0 : 1;
  }
  EXPECT_GE(held, 0.89 * kTrials);
  EXPECT_LE(held, 0.99 * kTrials);
}

TEST(Bootstrap, SameForAnyNumberOfThreadsAndOtherForAnotherSeed) {
  const std::vector<double> values = normalValues(5, 30);
  setThreadCount(1);
  const Interval one = bootstrapIntervals(values.size(), meanOf(values)).at(0);
  setThreadCount(0);
  const Interval all = bootstrapIntervals(values.size(), meanOf(values)).at(0);
  EXPECT_EQ(one.low, all.low);
  EXPECT_EQ(one.high, all.high);
  BootstrapOptions options;
  options.seed = 2;
  EXPECT_NE(bootstrapIntervals(values.size(), meanOf(values), options).at(0).low, one.low);
}

TEST(Bootstrap, OneUnitHasNoSpread) {
  const Interval interval = bootstrapIntervals(1, meanOf({0.25})).at(0);
  EXPECT_EQ(interval.low, 0.25);
  EXPECT_EQ(interval.high, 0.25);
  EXPECT_FALSE(interval.leavesOut(0.25));
  EXPECT_TRUE(interval.leavesOut(0.0));
}

TEST(Bootstrap, DrawsWithoutAnythingToCountAreLeftOut) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto first_only = [&](const std::vector<std::size_t>& drawn) {
    return std::vector<double>{drawn[0] == 0 ? 3.0 : nothing, nothing};
  };
  const std::vector<Interval> intervals = bootstrapIntervals(2, first_only);
  EXPECT_EQ(intervals.at(0).low, 3.0);
  EXPECT_EQ(intervals.at(0).high, 3.0);
  EXPECT_TRUE(std::isnan(intervals.at(1).low));
  EXPECT_FALSE(intervals.at(1).leavesOut(0.0));
}

TEST(Bootstrap, OptionsAreChecked) {
  BootstrapOptions options;
  options.draws = 0;
  EXPECT_THROW(bootstrapIntervals(1, meanOf({1.0}), options), Error);
  options = {};
  options.level = 1.0;
  EXPECT_THROW(bootstrapIntervals(1, meanOf({1.0}), options), Error);
  EXPECT_THROW(bootstrapIntervals(0, meanOf({})), Error);
}

}  // namespace
}  // namespace rangepose
