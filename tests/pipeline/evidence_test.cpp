// What makes a pose less sure. The weights are fitted; that each of them points the right way, that
// the score is bounded by what was seen, and that what says nothing is silent, is not.
#include "pipeline/evidence.h"

#include <gtest/gtest.h>

#include <limits>

namespace rangepose {
namespace {

/// A part that is seen nearly whole and ends where the data does.
CheckResult sure() {
  CheckResult check;
  check.explained = 0.95;
  check.explained_mm2 = 950.0;
  check.outline = 0.98;
  check.relief = 2.0;
  check.whole_relief = 2.5;
  check.inner_px = 2000.0;
  return check;
}

EvidenceContext context() {
  EvidenceContext result;
  result.mean_visible_mm2 = 1000.0;
  return result;
}

double oddsOf(const CheckResult& check, const EvidenceContext& around = context()) {
  return logOddsOf(evidenceTerms(check, around), check.inner_px);
}

double oddsWith(double CheckResult::*field, double value) {
  CheckResult check = sure();
  check.*field = value;
  return oddsOf(check);
}

TEST(EvidenceTest, APartSeenWholeIsSure) { EXPECT_GT(probabilityOf(oddsOf(sure())), 0.9); }

TEST(EvidenceTest, WhatSpeaksAgainstAPoseMakesItLessSure) {
  const double before = oddsOf(sure());
  EXPECT_LT(oddsWith(&CheckResult::seen_through, 0.1), before) << "the sensor saw through it";
  EXPECT_LT(oddsWith(&CheckResult::buried, 0.1), before) << "another surface lies over it";
  EXPECT_LT(oddsWith(&CheckResult::outline, 0.6), before) << "the data goes on";
  EXPECT_LT(oddsWith(&CheckResult::relief, 0.3), before) << "any smooth surface would do";
  EXPECT_LT(oddsWith(&CheckResult::explained_mm2, 100.0), before) << "little of it is to be seen";
  EvidenceContext through_floor = context();
  through_floor.outside = 0.2;
  EXPECT_LT(oddsOf(sure(), through_floor), before) << "it reaches through the floor";
}

TEST(EvidenceTest, WhatTellsAPartFromPlainOnesMustBeSeen) {
  CheckResult pin = sure();
  pin.relief = 0.1;
  CheckResult rod = pin;
  rod.whole_relief = 0.1;
  EXPECT_LT(probabilityOf(oddsOf(pin)), 0.75) << "a headed pin is found on a plain rod";
  EXPECT_GT(oddsOf(rod), oddsOf(pin) + 1.0) << "a rod has nothing else to show";
}

TEST(EvidenceTest, NothingSeenThroughIsAsGoodAsAPixelOfIt) {
  EXPECT_NEAR(oddsWith(&CheckResult::seen_through, 0.001), oddsOf(sure()), 0.2)
      << "a stray pixel decides";
}

TEST(EvidenceTest, AScoreIsBoundedByWhatWasSeen) {
  // A cloud of a thousand points once gave a part on one pixel a score of 0.98.
  EXPECT_EQ(probabilityOf(oddsWith(&CheckResult::inner_px, 0.0)), 0.0)
      << "what is nowhere wider than two pixels shows no surface";
  EXPECT_LT(probabilityOf(oddsWith(&CheckResult::inner_px, 30.0)), 0.5);
  EXPECT_LT(probabilityOf(oddsWith(&CheckResult::inner_px, 200.0)), 0.9);
  EXPECT_EQ(oddsWith(&CheckResult::inner_px, 1e5), oddsWith(&CheckResult::inner_px, 1e9))
      << "what many pixels say is bounded by their shares alone";
}

TEST(EvidenceTest, WhatFoundPartsHideDoesNotSpeakAgainstAPose) {
  CheckResult check = sure();
  check.buried = 0.2;
  EvidenceTerms terms = evidenceTerms(check, context());
  terms[static_cast<std::size_t>(EvidenceTerm::kBuried)] = buriedTerm(sure());
  EXPECT_NEAR(logOddsOf(terms, check.inner_px), oddsOf(sure()), 1e-12);
}

TEST(EvidenceTest, EveryTermHasANameOfItsOwn) {
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_STRNE(nameOf(static_cast<EvidenceTerm>(i)), nameOf(static_cast<EvidenceTerm>(j)));
    }
  }
}

}  // namespace
}  // namespace rangepose
