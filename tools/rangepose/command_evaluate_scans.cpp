// rangepose evaluate --scans: what the sensor did to surfaces of known pose.
#include <fmt/format.h>

#include <iostream>

#include "core/error.h"
#include "eval/scan_statistics_report.h"
#include "io/atomic_file.h"
#include "rangepose/command.h"
#include "rangepose/command_evaluate.h"
#include "rangepose/progress.h"

namespace rangepose::cli {
namespace {

constexpr const char* kOwnTruth = "-";

std::vector<ScanSet> setsOf(const EvaluateScansArguments& arguments) {
  std::vector<ScanSet> sets;
  for (std::size_t i = 0; i < arguments.folders.size(); ++i) {
    ScanSet set;
    set.folder = arguments.folders[i];
    set.split = arguments.split;
    if (!arguments.truths.empty() && arguments.truths[i] != kOwnTruth) {
      set.truth = arguments.truths[i];
    }
    sets.push_back(set);
  }
  return sets;
}

}  // namespace

void checkScansUsage(const EvaluateScansArguments& arguments) {
  if (arguments.folders.empty() && !arguments.truths.empty()) {
    throw UsageError("--truth belongs to --scans; give --scans DIR");
  }
  if (!arguments.truths.empty() && arguments.truths.size() != arguments.folders.size()) {
    throw UsageError(fmt::format("{} --truth for {} --scans; give one each, - for a set's own",
                                 arguments.truths.size(),
                                 arguments.folders.size()));
  }
}

int evaluateScans(const EvaluateScansArguments& arguments, const std::string& out) {
  std::vector<ScanStatistics> statistics;
  for (const ScanSet& set : setsOf(arguments)) {
    Progress progress(std::cerr, "measuring", 0, terminalProgress());
    statistics.push_back(measureScans(set));
  }
  const std::string markdown = scanMarkdown(statistics);
  if (!out.empty()) {
    const std::filesystem::path folder = out;
    writeFileAtomically(folder / "table.md", markdown);
    writeFileAtomically(folder / "table.csv", scanCsv(statistics));
  }
  std::cout << markdown;
  return kDone;
}

}  // namespace rangepose::cli
