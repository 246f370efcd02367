// The figures of the gate by name: what tables, files and checks have in common.
#pragma once

#include <string>
#include <vector>

#include "eval/gate_figures.h"

namespace rangepose {

struct GateColumn {
  const char* key;                      ///< in files
  const char* title;                    ///< in tables
  bool share;                           ///< 0..1, in per cent in tables
  int decimals;                         ///< in tables
  bool in_table;                        ///< else in files only
  bool compared;                        ///< in the table of differences
  double (*value)(const GateFigures&);  ///< shares 0..1; NaN where there is nothing to count
};

const std::vector<GateColumn>& gateColumns();

/// Throws Error where there is none of this key.
const GateColumn& gateColumn(const std::string& key);

/// As tables show it: "-" for NaN, shares in percent; `sign`: a difference, with + or -.
std::string figureText(const GateColumn& column, double value, bool sign = false);

}  // namespace rangepose
