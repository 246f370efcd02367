// The figures of scan_statistics.h as a table: a row a figure, a column a data set.
#pragma once

#include <string>
#include <vector>

#include "eval/scan_statistics.h"

namespace rangepose {

/// What the figures mean is written below the table.
std::string scanMarkdown(const std::vector<ScanStatistics>& sets);

/// Six digits a figure; empty where there was nothing to measure.
std::string scanCsv(const std::vector<ScanStatistics>& sets);

}  // namespace rangepose
