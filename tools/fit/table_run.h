// Makes the table of evidence: all poses that rangepose knows of in simulated bins, and whether
// they are right.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fit/evidence_table.h"
#include "gate/cache.h"
#include "gate/recipes.h"

namespace rangepose::fit {

struct TablePlan {
  gate::BinSet set;
  std::vector<gate::SensorRecipe> sensors;
  std::filesystem::path models;
  std::filesystem::path program;  ///< a rangepose, which makes bins and databases
};

/// By sensor, kind, image and falling score. Draws progress on stderr where that is a terminal.
std::vector<EvidenceRow> evidenceTable(const TablePlan& plan, gate::Cache& cache);

}  // namespace rangepose::fit
