// Options that the paper leaves open or that differ from it, each changed by itself.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/estimate.h"

namespace rangepose {

struct AblationRow {
  std::string name;
  std::function<void(EstimateOptions&)> change;
  int size = 0;          ///< width of a reference [px]; 0: as in the other rows
  double scan_mm = 0.0;  ///< pixel of the scan [mm]; 0: likewise
};

/// The released options first.
std::vector<AblationRow> ablationRows();

}  // namespace rangepose
