// rangepose_gate: what a change does to what users see, on the sensors that users have.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "gate/gate_report.h"
#include "gate/gate_rows.h"
#include "gate/gate_run.h"
#include "gate/short_check.h"
#include "io/atomic_file.h"

namespace rangepose::gate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples = R"(Run in the folder of the sources. Examples:
  rangepose_gate --set report --out build/report
  rangepose_gate --set choose --sensor stereo --sensor tof --bins 2
  rangepose_gate --set choose --binary new/rangepose --against old/rangepose
                                              A is --against, B is --binary: what B changed
  rangepose_gate --set report --ppf build/release/tools/peers/rangepose_ppf
  rangepose_gate --check tests/gate/short.json            the short gate, as ctest runs it
  rangepose_gate --check tests/gate/short.json --record   its figures are new on purpose
Bins, databases and answers are kept in the cache, named by what they depend on: the bytes of the
programs and meshes, and what the simulator makes of a tiny bin. docs/gate.md tells what the columns
mean. Exit codes: 0 done, 1 failed (--check: a figure went the wrong way), 2 wrong usage.)";

struct Arguments {
  std::string set;
  std::vector<std::string> sensors;
  std::vector<std::string> kinds;
  int bins = 0;
  std::string binary = "build/release/tools/rangepose/rangepose";
  std::string against;
  std::string ppf;
  std::string simulator;
  std::string recipes = "tools/gate/bins.json";
  std::string models = "models";
  std::string cache = "build/gate";
  std::string out;
  std::string check;
  bool record = false;
  int threads = 0;
  double min_score = 0.05;
};

void declareOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--set", arguments.set, "Of bins: fit, choose or report");
  app.add_option("--sensor", arguments.sensors, "Only these [all of the recipes]");
  app.add_option("--kind", arguments.kinds, "Only these kinds of bins [all of the set]");
  app.add_option("--bins", arguments.bins, "Bins of each kind [as in the recipes]")
      ->check(CLI::Range(1, 1000));
  app.add_option("--binary", arguments.binary, "The rangepose that is measured")
      ->capture_default_str();
  app.add_option("--against", arguments.against, "Another one, that it is compared with");
  app.add_option("--ppf", arguments.ppf, "rangepose_ppf, for rows of its own");
  app.add_option("--simulator", arguments.simulator, "The rangepose that makes bins [--binary]");
  app.add_option("--recipes", arguments.recipes, "What bins there are")->capture_default_str();
  app.add_option("--models", arguments.models, "Folder of the parts")->capture_default_str();
  app.add_option("--cache", arguments.cache, "Folder for what is made")->capture_default_str();
  app.add_option("--out", arguments.out, "Folder for table.md, table.csv and gate.json");
  app.add_option("--threads", arguments.threads, "0: all cores; no effect on answers")
      ->check(CLI::Range(0, 1024));
  app.add_option("--min-score", arguments.min_score, "Score limit of the checked poses")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  auto* check = app.add_option("--check", arguments.check, "The short gate of this file");
  app.add_flag("--record", arguments.record, "Write the figures of --check as what is expected")
      ->needs(check);
  for (const char* name : {"--set",
                           "--sensor",
                           "--kind",
                           "--bins",
                           "--against",
                           "--ppf",
                           "--recipes",
                           "--out",
                           "--min-score"}) {
    check->excludes(app.get_option(name));
  }
  app.footer(kExamples);
}

std::vector<System> systemsOf(const Arguments& arguments) {
  std::vector<System> systems;
  if (arguments.against.empty()) {
    systems.push_back({"rangepose", arguments.binary});
  } else {
    systems.push_back({"A", arguments.against});
    systems.push_back({"B", arguments.binary});
  }
  if (!arguments.ppf.empty()) systems.push_back({"OpenCV PPF", arguments.ppf, true});
  return systems;
}

GatePlan planOf(const Arguments& arguments, const Recipes& recipes, const std::string& set) {
  GatePlan plan;
  plan.set = recipes.set(set);
  plan.kinds = kindsOf(plan.set, arguments.kinds, arguments.bins);
  plan.sensors = sensorsOf(recipes, arguments.sensors);
  plan.models = arguments.models;
  plan.simulator = arguments.simulator.empty() ? arguments.binary : arguments.simulator;
  plan.systems = systemsOf(arguments);
  plan.low_score = arguments.min_score;
  plan.threads = arguments.threads;
  return plan;
}

int runTable(const Arguments& arguments) {
  const Recipes recipes = readRecipes(arguments.recipes);
  const GatePlan plan = planOf(arguments, recipes, arguments.set);
  if (!arguments.out.empty()) fs::create_directories(arguments.out);
  Cache cache(arguments.cache, arguments.threads);
  GateReport report;
  report.head = headOf(plan, cache);
  const std::vector<GateCell> cells = gateCells(plan, cache);
  report.rows = gateRows(cells, plan.systems);
  if (!arguments.against.empty()) report.differences = differenceRows(cells, 1);
  const std::string markdown = reportMarkdown(report);
  if (!arguments.out.empty()) {
    const fs::path out = arguments.out;
    writeFileAtomically(out / "table.md", markdown);
    writeFileAtomically(out / "table.csv", gateCsv(report.rows));
    writeFileAtomically(out / "gate.json", reportJson(report));
  }
  std::cout << markdown;
  return 0;
}

int runCheck(const Arguments& arguments) {
  const ShortGate gate = readShortGate(arguments.check);
  const GatePlan plan = planOf(arguments, gate.recipes, gate.recipes.sets.front().name);
  Cache cache(arguments.cache, arguments.threads);
  const std::vector<GateRow> rows = gateRows(gateCells(plan, cache), plan.systems);
  std::cout << gateMarkdown(rows) << "\n";
  if (arguments.record) {
    writeFileAtomically(arguments.check, recorded(arguments.check, rows));
    std::cout << "recorded in " << arguments.check << "\n";
    return 0;
  }
  const std::vector<Movement> moved = movements(gate, rows);
  const auto fails = std::count_if(
      moved.begin(), moved.end(), [](const Movement& movement) { return movement.fails; });
  std::cout << movementText(moved)
            << fmt::format("{} figures moved, {} of them failed\n", moved.size(), fails);
  return fails > 0 ? 1 : 0;
}

int run(const Arguments& arguments) {
  setThreadCount(arguments.threads);
  if (!arguments.check.empty()) return runCheck(arguments);
  return runTable(arguments);
}

}  // namespace
}  // namespace rangepose::gate

int main(int argc, char** argv) {
  try {
    CLI::App app("Tells what a change does to what users see, on the sensors that they have.");
    rangepose::gate::Arguments arguments;
    rangepose::gate::declareOptions(app, arguments);
    try {
      app.parse(argc, argv);
      if (arguments.set.empty() && arguments.check.empty()) throw CLI::RequiredError("--set");
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : 2;
    }
    return rangepose::gate::run(arguments);
  } catch (const std::exception& error) {
    std::cout.flush();
    std::cerr << "rangepose_gate: " << error.what() << '\n';
    return 1;
  }
}
