// The weights of the evidence, by logistic regression.
#pragma once

#include <vector>

#include "fit/evidence_table.h"

namespace rangepose::fit {

/// Weights that make the right poses of the rows likeliest, each term pulled a little to zero (L2,
/// in units of its spread) but for the first. Every sensor counts the same, however many rows it
/// has. Throws Error for rows without a right or without a wrong pose.
EvidenceTerms fitEvidence(const std::vector<EvidenceRow>& rows);

/// What the evidence is fitted to: chosen poses, and right ones that should have been. Wrong ones
/// that were refused in the end for a rival are no example.
std::vector<EvidenceRow> examplesOf(const std::vector<EvidenceRow>& rows);

}  // namespace rangepose::fit
