// Options of `estimate` about what to pick first and what a robot cannot reach.
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "pipeline/picking.h"

namespace rangepose::cli {

struct PickingArguments {
  double approach_cone_deg = 0.0;
  double min_freedom = 0.0;
  std::vector<double> workspace;  ///< x0 x1 y0 y1 z0 z1 [mm]; empty: no limit
  std::vector<double> arm;        ///< x y z [mm]; empty: none

  bool limited() const { return min_freedom > 0.0 || !workspace.empty(); }
  bool given() const { return limited() || approach_cone_deg != 0.0 || !arm.empty(); }
};

/// --approach-cone, --min-freedom, --workspace, --arm.
void declarePicking(CLI::App& command, PickingArguments& arguments);

/// Throws UsageError for values that make no sense.
PickOptions pickingOptions(const PickingArguments& arguments);

/// Leaves those of the poses that are in `picks`, in their order.
void keepPicks(Estimate& estimate, const std::vector<Pick>& picks);

}  // namespace rangepose::cli
