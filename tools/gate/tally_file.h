// Tallies as text, so that answers are graded once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "eval/gate_figures.h"

namespace rangepose::gate {

/// The tallies of a system on the bins of a kind.
struct CellTallies {
  std::vector<ImageTally> all;
  std::vector<std::vector<ImageTally>> of_part;  ///< of mixed bins of several parts, else empty
};

/// JSON; every number comes back bit by bit.
std::string talliesText(const CellTallies& tallies);

/// Throws Error, with `where`, for a text that talliesText() has not made.
CellTallies talliesFrom(std::string_view text, const std::string& where);

}  // namespace rangepose::gate
