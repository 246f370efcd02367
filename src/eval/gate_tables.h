// The figures of the gate as Markdown and CSV.
#pragma once

#include <string>
#include <vector>

#include "eval/gate_columns.h"
#include "eval/gate_difference.h"

namespace rangepose {

inline constexpr const char* kAllKinds = "all";

struct GateRow {
  std::string sensor;
  std::string kind;    ///< of bins, or kAllKinds
  std::string part;    ///< empty: all
  std::string system;  ///< whose answers are graded
  GateFigures figures;
};

struct GateDifferenceRow {
  std::string sensor;
  std::string kind;
  GateDifference difference;
};

std::string gateMarkdown(const std::vector<GateRow>& rows);

/// By tenth of score, of each row over all kinds.
std::string calibrationMarkdown(const std::vector<GateRow>& rows);

/// A change, its interval, and * where the interval leaves out 0.
std::string differenceMarkdown(const std::vector<GateDifferenceRow>& rows);

/// One line a row with all columns; shares are 0..1, empty where there is nothing to count.
std::string gateCsv(const std::vector<GateRow>& rows);

}  // namespace rangepose
