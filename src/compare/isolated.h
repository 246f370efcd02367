// Every stage on both paths, each fed what the reference made.
#pragma once

#include <vector>

#include "compare/compare.h"

namespace rangepose {

/// `estimate` and `trace` are those of the reference.
std::vector<StageComparison> compareIsolated(const DepthImage& depth,
                                             const std::optional<BinBox>& bin,
                                             const ReferenceDatabase& database,
                                             const Estimate& estimate,
                                             const EstimateTrace& trace,
                                             StageSet& reference,
                                             StageSet& subject);

}  // namespace rangepose
