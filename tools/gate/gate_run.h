// Runs systems over the bins of a set and grades their answers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gate/cache.h"
#include "gate/recipes.h"
#include "gate/tally_file.h"

namespace rangepose::gate {

struct System {
  std::string name;  ///< in tables
  std::filesystem::path program;
  bool ppf = false;  ///< rangepose_ppf, else rangepose
};

/// What to run. Names are checked by gateCells().
struct GatePlan {
  BinSet set;
  std::vector<SensorRecipe> sensors;
  std::vector<BinKind> kinds;  ///< those of the set that are wanted
  std::filesystem::path models;
  std::filesystem::path simulator;
  std::vector<System> systems;  ///< the first one makes the databases of those that cannot
  double low_score = 0.05;      ///< limit of the second run
  int threads = 0;
};

/// The bins of a kind as a sensor sees them.
struct GateCell {
  std::string sensor;
  BinKind kind;
  std::vector<CellTallies> systems;  ///< as in GatePlan
};

/// By sensor and kind. Draws progress on stderr where that is a terminal.
std::vector<GateCell> gateCells(const GatePlan& plan, Cache& cache);

}  // namespace rangepose::gate
