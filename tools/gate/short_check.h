// The short version of the gate: a few small bins whose figures are on record. The same program
// gives the same figures, so that what moves was moved by a change.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "eval/gate_tables.h"
#include "gate/recipes.h"

namespace rangepose::gate {

/// Figures by their keys (gate_columns.h); NaN where there is nothing to count.
using FiguresByKey = std::map<std::string, double>;

struct ExpectedRow {
  std::string sensor;
  std::string kind;
  FiguresByKey figures;
};

struct ShortGate {
  Recipes recipes;                    ///< with one set
  FiguresByKey slack;                 ///< how far a figure may go the wrong way
  std::vector<ExpectedRow> expected;  ///< on record
};

/// Throws Error, naming the field, for what is unknown, missing or out of range.
ShortGate readShortGate(const std::filesystem::path& path);

/// A figure that is not as recorded.
struct Movement {
  std::string sensor;
  std::string kind;
  std::string figure;
  double was = 0.0;
  double now = 0.0;
  double slack = 0.0;
  bool fails = false;  ///< went the wrong way by more than `slack`
};

/// What moved, parts of mixed bins left out. Figures that should be high fail when they fall, the
/// Brier score and the calibration error when they rise, mean scores and counts when they move at
/// all; of a single kind only the counts fail. Throws Error where rows are missing or too many.
std::vector<Movement> movements(const ShortGate& gate, const std::vector<GateRow>& rows);

/// A line for each movement, those that fail last.
std::string movementText(const std::vector<Movement>& movements);

/// The text of the file with the rows as what is expected; all else stays as it is.
std::string recorded(const std::filesystem::path& path, const std::vector<GateRow>& rows);

}  // namespace rangepose::gate
