// The stages of refinement on both paths: poses aligned and judged, by the points of their views
// and by rendered surfaces.
#pragma once

#include <vector>

#include "compare/tally.h"

namespace rangepose {

/// `trace` is that of the reference; its candidates of the coarse alignment are aligned again.
std::vector<StageComparison> compareRefinement(const DepthImage& depth,
                                               const ReferenceDatabase& database,
                                               const Estimate& estimate,
                                               const EstimateTrace& trace,
                                               StageSet& reference,
                                               StageSet& subject);

}  // namespace rangepose
