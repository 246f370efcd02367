// What makes a pose less sure. The weights are fitted; that each of them points the right way, and
// is silent where it has nothing to say, is not.
#include "pipeline/confidence.h"

#include <gtest/gtest.h>

#include <numbers>

namespace rangepose {
namespace {

/// A part that is seen nearly whole and ends where the data does.
CheckResult sure() {
  CheckResult check;
  check.explained = 0.95;
  check.contradicted = 0.01;
  check.outline = 0.95;
  check.flat = 0.6;
  check.stability = 0.5;
  check.jumps_met = 0.9;
  return check;
}

double oddsWith(double CheckResult::*field, double value) {
  CheckResult check = sure();
  check.*field = value;
  return logOddsOf(check, 1.0, 0.0);
}

TEST(ConfidenceTest, APartSeenWholeIsSure) {
  EXPECT_GT(probabilityOf(logOddsOf(sure(), 1.0, 0.0)), 0.99);
  EXPECT_LT(probabilityOf(logOddsOf(sure(), 0.01, 0.0)), 0.5) << "a sliver fits anything";
}

TEST(ConfidenceTest, WhatSpeaksAgainstAPoseMakesItLessSure) {
  const double before = logOddsOf(sure(), 1.0, 0.0);
  EXPECT_LT(oddsWith(&CheckResult::contradicted, 0.1), before) << "seen through";
  EXPECT_LT(oddsWith(&CheckResult::buried, 0.1), before) << "another surface lies over it";
  EXPECT_LT(oddsWith(&CheckResult::outline, 0.7), before) << "the data goes on";
  EXPECT_LT(oddsWith(&CheckResult::missing, 0.6), before) << "little of it was measured";
  EXPECT_LT(oddsWith(&CheckResult::hidden, 0.6), before) << "little of it is to be seen";
  EXPECT_LT(oddsWith(&CheckResult::stability, 0.01), before) << "it fits wherever it slides to";
  EXPECT_LT(oddsWith(&CheckResult::jumps_met, 0.1), before) << "its steps are not in the data";
  EXPECT_LT(oddsWith(&CheckResult::jumps_missed, 0.5), before) << "the data is level there";
}

/// What it costs that a face is as flat as `flat`, where the data goes on beyond the part.
double costOfFlatness(double flat) {
  CheckResult round = sure();
  round.outline = 0.8;
  CheckResult check = round;
  check.flat = flat;
  return logOddsOf(round, 1.0, 0.0) - logOddsOf(check, 1.0, 0.0);
}

TEST(ConfidenceTest, FlatFacesMustEndWithTheData) {
  EXPECT_GT(costOfFlatness(1.0), 3.0) << "a plate is found on any larger face";
  // Else pipes and rods in touch with others are missed.
  EXPECT_DOUBLE_EQ(costOfFlatness(0.25 * std::numbers::pi), 0.0) << "a half cylinder is not flat";
  EXPECT_DOUBLE_EQ(oddsWith(&CheckResult::flat, 1.0), oddsWith(&CheckResult::flat, 0.0))
      << "a plate that ends where the data does is as sure as anything";
}

}  // namespace
}  // namespace rangepose
