// The weights of the evidence are those that a fit gives: else nobody can change a term.
#include "fit/evidence_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"

namespace rangepose::fit {
namespace {

std::vector<EvidenceRow> committed() {
  return readTable(std::filesystem::path(RP_SOURCE_DIR) / "tests" / "fit" / "evidence.csv");
}

TEST(EvidenceFitTest, FindsTheWeightsThatAreReleased) {
  const EvidenceTerms fitted = fitEvidence(examplesOf(committed()));
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    EXPECT_NEAR(fitted[i], evidenceWeights()[i], 1e-3 * std::abs(fitted[i]) + 1e-3)
        << nameOf(static_cast<EvidenceTerm>(i))
        << ": run rangepose_fit weights tests/fit/evidence.csv";
  }
}

TEST(EvidenceFitTest, FindsTheWeightsThatMadeTheTruth) {
  // Odds of 2 - 3 ends, without any other term.
  std::vector<EvidenceRow> rows;
  for (int i = 0; i <= 20; ++i) {
    const double ends = i / 20.0;
    const double p = probabilityOf(2.0 - 3.0 * ends);
    for (int k = 0; k < 1000; ++k) {
      EvidenceRow row;
      row.sensor = "one";
      row.right = k < 1000.0 * p;
      row.chosen = true;
      row.terms[0] = 1.0;
      row.terms[static_cast<std::size_t>(EvidenceTerm::kEnds)] = ends;
      rows.push_back(row);
    }
  }
  const EvidenceTerms fitted = fitEvidence(rows);
  EXPECT_NEAR(fitted[0], 2.0, 0.02);
  EXPECT_NEAR(fitted[static_cast<std::size_t>(EvidenceTerm::kEnds)], -3.0, 0.03);
  EXPECT_EQ(fitted[static_cast<std::size_t>(EvidenceTerm::kBuried)], 0.0);
}

TEST(EvidenceFitTest, AllOfOneKindIsRefused) {
  std::vector<EvidenceRow> rows = committed();
  for (EvidenceRow& row : rows) row.right = true;
  EXPECT_THROW(static_cast<void>(fitEvidence(rows)), Error);
}

TEST(EvidenceTableTest, WhatIsWrittenIsRead) {
  const std::vector<EvidenceRow> rows = committed();
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "evidence_table_test.csv";
  std::ofstream(path) << tableText(rows);
  const std::vector<EvidenceRow> again = readTable(path);
  ASSERT_EQ(again.size(), rows.size());
  EXPECT_EQ(tableText(again), tableText(rows));
  std::ofstream(path, std::ios::app) << "structured-light,bolt,1\n";
  EXPECT_THROW(static_cast<void>(readTable(path)), Error) << "half a row would be fitted to";
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace rangepose::fit
