// Pictures of every stage of one estimate.
#pragma once

#include "debug/dump.h"
#include "pipeline/estimate.h"

namespace rangepose::cli {

/// Adds what the trace holds of the first object and, if it is another one, of the best pose's
/// object; then the poses before and after refinement; then writes the page.
void finishDump(debug::StageDump& dump,
                const DepthImage& depth,
                const ReferenceDatabase& database,
                const Estimate& estimate,
                const EstimateTrace& trace);

}  // namespace rangepose::cli
