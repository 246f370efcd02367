// rangepose_fit: fits the weights of the evidence (src/pipeline/evidence.h).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <map>
#include <numeric>

#include "core/error.h"
#include "eval/judged_poses.h"
#include "fit/evidence_fit.h"
#include "fit/table_run.h"
#include "io/atomic_file.h"

namespace rangepose::fit {
namespace {

constexpr const char* kExamples = R"(Run in the folder of the sources. Examples:
  rangepose_fit table --out build/evidence.csv             all poses known in the fitting bins
  rangepose_fit table --out tests/fit/evidence.csv --examples   what the weights were fitted to
  rangepose_fit table --out choose.csv --set choose        of other bins, to look at
  rangepose_fit weights build/evidence.csv                 the weights, as in src/pipeline/evidence.cpp
  rangepose_fit weights build/evidence.csv --check choose.csv   and how well they do elsewhere
Bins and databases are kept in the cache, as the gate's. Exit codes: 0 done, 1 failed, 2 wrong usage.)";

struct Arguments {
  std::string set = "fit";
  std::vector<std::string> sensors;
  std::vector<std::string> kinds;
  int bins = 0;
  std::string binary = "build/release/tools/rangepose/rangepose";
  std::string recipes = "tools/gate/bins.json";
  std::string models = "models";
  std::string cache = "build/gate";
  std::string out;
  bool examples = false;
  std::string table;
  std::string check;
};

void runTable(const Arguments& arguments) {
  const gate::Recipes recipes = gate::readRecipes(arguments.recipes);
  TablePlan plan;
  plan.set = recipes.set(arguments.set);
  plan.set.kinds = gate::kindsOf(plan.set, arguments.kinds, arguments.bins);
  plan.sensors = gate::sensorsOf(recipes, arguments.sensors);
  plan.models = arguments.models;
  plan.program = arguments.binary;
  gate::Cache cache(arguments.cache, 0);
  const std::vector<EvidenceRow> rows = evidenceTable(plan, cache);
  writeFileAtomically(arguments.out, tableText(arguments.examples ? examplesOf(rows) : rows));
}

/// How the scores of the chosen poses fit, sensor by sensor.
void printCalibration(const std::vector<EvidenceRow>& rows, const EvidenceTerms& weights) {
  std::map<std::string, std::vector<JudgedPose>> of_sensor;
  for (const EvidenceRow& row : rows) {
    if (!row.chosen) continue;
    const double odds =
        std::inner_product(row.terms.begin(), row.terms.end(), weights.begin(), 0.0);
    of_sensor[row.sensor].push_back(
        {probabilityOf(odds), row.right ? PoseVerdict::kFound : PoseVerdict::kFalse});
  }
  fmt::print("| sensor | score | poses | mean score | right [%] |\n|---|---|---|---|---|\n");
  for (const auto& [sensor, poses] : of_sensor) {
    for (const ReliabilityBin& bin : reliabilityOf(poses)) {
      if (bin.count == 0) continue;
      fmt::print("| {} | {:.1f} to {:.1f} | {} | {:.3f} | {:.1f} |\n",
                 sensor,
                 bin.low,
                 bin.high,
                 bin.count,
                 bin.mean_score,
                 100.0 * bin.right);
    }
  }
}

void runWeights(const Arguments& arguments) {
  const std::vector<EvidenceRow> rows = readTable(arguments.table);
  const EvidenceTerms weights = fitEvidence(examplesOf(rows));
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    fmt::print("{:<13}{:9.3f}\n", nameOf(static_cast<EvidenceTerm>(i)), weights[i]);
  }
  fmt::print("\nShare right of chosen poses, for their mean score, by tenth of the score:\n");
  printCalibration(rows, weights);
  if (arguments.check.empty()) return;
  fmt::print("\nThe same of {}:\n", arguments.check);
  printCalibration(readTable(arguments.check), weights);
}

int run(int argc, char** argv) {
  CLI::App app("Fits the weights of the evidence, by which poses are scored.");
  Arguments arguments;
  app.require_subcommand(1);
  app.footer(kExamples);
  CLI::App* table = app.add_subcommand("table", "Writes a table of known poses and their evidence");
  table->add_option("--out", arguments.out, "The table")->required();
  table->add_flag("--examples", arguments.examples, "Only poses that weights are fitted to");
  table->add_option("--set", arguments.set, "Of bins: fit, choose or report")
      ->capture_default_str();
  table->add_option("--sensor", arguments.sensors, "Only these [all of the recipes]");
  table->add_option("--kind", arguments.kinds, "Only these kinds of bins [all of the set]");
  table->add_option("--bins", arguments.bins, "Bins of each kind [as in the recipes]")
      ->check(CLI::Range(1, 1000));
  table->add_option("--binary", arguments.binary, "A rangepose, to make bins and databases")
      ->capture_default_str();
  table->add_option("--recipes", arguments.recipes, "What bins there are")->capture_default_str();
  table->add_option("--models", arguments.models, "Folder of the parts")->capture_default_str();
  table->add_option("--cache", arguments.cache, "Folder for what is made")->capture_default_str();
  CLI::App* weights = app.add_subcommand("weights", "Fits the weights to a table and prints them");
  weights->add_option("TABLE", arguments.table, "As `table` writes it")->required();
  weights->add_option("--check", arguments.check, "Another table, that they are tried on");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (table->parsed()) runTable(arguments);
  if (weights->parsed()) runWeights(arguments);
  return 0;
}

}  // namespace
}  // namespace rangepose::fit

int main(int argc, char** argv) {
  try {
    return rangepose::fit::run(argc, argv);
  } catch (const std::exception& error) {
    std::cout.flush();
    std::cerr << "rangepose_fit: " << error.what() << '\n';
    return 1;
  }
}
