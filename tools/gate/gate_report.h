// What a run of the gate prints and writes.
#pragma once

#include <string>
#include <vector>

#include "eval/gate_tables.h"
#include "gate/gate_run.h"

namespace rangepose::gate {

struct GateReport {
  std::vector<std::pair<std::string, std::string>> head;  ///< date, processor, bins, ...
  std::vector<GateRow> rows;
  std::vector<GateDifferenceRow> differences;  ///< empty with one binary
};

/// Facts on the machine and on the run.
std::vector<std::pair<std::string, std::string>> headOf(const GatePlan& plan, Cache& cache);

std::string reportMarkdown(const GateReport& report);

/// All figures by their keys; null where there is nothing to count.
std::string reportJson(const GateReport& report);

}  // namespace rangepose::gate
