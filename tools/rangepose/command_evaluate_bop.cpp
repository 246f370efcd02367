// rangepose evaluate --bop: a result file against the truth of a data set.
#include <iostream>

#include "core/error.h"
#include "eval/score_report.h"
#include "io/atomic_file.h"
#include "rangepose/command.h"
#include "rangepose/command_evaluate.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"

namespace rangepose::cli {
namespace {

GradedResults grade(const EvaluateBopArguments& arguments) {
  const std::vector<BopEstimate> rows = readBopCsv(arguments.csv);
  const BopDataset data = openBop(arguments.folder, arguments.split);
  if (data.scenes.empty()) {
    throw Error("BOP data set " + arguments.folder + ": has no scenes in split " + arguments.split +
                "; name another one by --split");
  }
  Progress progress(std::cerr, "images", imageCount(data), terminalProgress());
  return gradeBop(data, rows, {}, [&progress](int done, int) { progress.update(done); });
}

}  // namespace

int evaluateBop(const EvaluateBopArguments& arguments, const std::string& out) {
  const GradedResults results = grade(arguments);
  for (const std::string& warning : results.warnings) printWarning(warning);
  const std::vector<ScoreRow> rows = scoreRows(results, arguments.picking);
  const std::string markdown = scoreMarkdown(results, rows, arguments.picking);
  if (!out.empty()) {
    const std::filesystem::path folder = out;
    writeFileAtomically(folder / "table.md", markdown);
    writeFileAtomically(folder / "table.csv", scoreCsv(rows));
    writeScorePlots(folder, rows, arguments.picking);
  }
  std::cout << markdown;
  return kDone;
}

}  // namespace rangepose::cli
