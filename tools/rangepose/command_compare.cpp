// rangepose compare: the stages on several paths, one beside the other.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/compare.h"
#include "core/parallel.h"
#include "io/atomic_file.h"
#include "pipeline/path_choice.h"
#include "rangepose/command.h"
#include "rangepose/compare_picture.h"
#include "rangepose/console.h"
#include "rangepose/cuda_options.h"
#include "rangepose/estimate_report.h"
#include "rangepose/progress.h"
#include "rangepose/scene_input.h"

namespace rangepose::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExamples =
    R"(The first path is the one that the others are compared with: each stage fed alike, then each
path by itself.

Examples:
  rangepose compare --db parts.rpdb --depth depth.png --camera camera.json --paths host,glsl
  rangepose compare --db parts.rpdb --cloud scan.ply --paths host,glsl --json -
  rangepose compare --db parts.rpdb --depth d.png --camera c.json --paths host,glsl,cuda --picture p.png)";

struct CompareArguments {
  SceneArguments scene;
  std::vector<std::string> paths = {"host", "glsl"};
  CudaArguments cuda;
  EstimateOptions options;
  int threads = 0;
  std::string json;
  std::string picture;
};

Json stageJson(const StageComparison& stage) {
  return {{"stage", stage.stage},
          {"differing", stage.differing},
          {"total", stage.total},
          {"max_difference", stage.max_difference},
          {"mean_difference", stage.mean_difference},
          {"unit", stage.unit},
          {"tolerance", stage.tolerance},
          {"allowed_share", stage.allowed_share},
          {"within", stage.within},
          {"reference_ms", stage.reference_ms},
          {"path_ms", stage.path_ms}};
}

Json stagesJson(const std::vector<StageComparison>& stages) {
  Json list = Json::array();
  for (const StageComparison& stage : stages) list.push_back(stageJson(stage));
  return list;
}

Json comparisonJson(const Comparison& comparison) {
  Json first = nullptr;
  if (comparison.first_out_of_tolerance) first = *comparison.first_out_of_tolerance;
  return {{"reference", comparison.reference},
          {"subject", comparison.subject},
          {"first_out_of_tolerance", first},
          {"isolated", stagesJson(comparison.isolated)},
          {"chained", stagesJson(comparison.chained)},
          {"verdict", comparison.verdict},
          {"draws", comparison.subject_work.draws},
          {"launches", comparison.subject_work.launches},
          {"left_to_host", comparison.left_to_host}};
}

void checkUsage(const CompareArguments& arguments) {
  checkScene(arguments.scene);
  if (arguments.paths.size() < 2)
    throw UsageError("--paths needs at least two paths, e.g. host,glsl");
  for (std::size_t i = 0; i < arguments.paths.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (arguments.paths[i] == arguments.paths[k]) {
        throw UsageError("--paths names " + arguments.paths[i] + " twice");
      }
    }
  }
}

int compare(const CompareArguments& arguments) {
  checkUsage(arguments);
  const bool to_stdout = arguments.json == "-";
  if (!arguments.json.empty() && !to_stdout) checkOutputFile(arguments.json);
  if (!arguments.picture.empty()) checkOutputFile(arguments.picture);
  setThreadCount(arguments.threads);
  std::vector<PathStages> paths;
  for (const std::string& name : arguments.paths) {
    paths.push_back(openPath(parsePathRequest(name), cudaOptions(arguments.cuda)));
  }
  const ReferenceDatabase database = readDatabase(arguments.scene.database);
  const DepthImage depth = readScene(arguments.scene);
  const std::optional<BinBox> bin = readBin(arguments.scene);
  Json list = Json::array();
  std::string text;
  for (std::size_t i = 1; i < paths.size(); ++i) {
    const Progress progress(std::cerr, "comparing", 0, terminalProgress());
    const Comparison comparison =
        comparePaths(depth, bin, database, arguments.options, *paths[0].stages, *paths[i].stages);
    text += comparisonTable(comparison);
    list.push_back(comparisonJson(comparison));
  }
  if (!arguments.picture.empty()) {
    std::vector<SeenPath> seen;
    for (const PathStages& path : paths) {
      const SeenPath* reference = seen.empty() ? nullptr : &seen.front();
      seen.push_back(seeOnPath(*path.stages, depth, bin, database, arguments.options, reference));
    }
    writeComparison(arguments.picture, seen);
  }
  const std::string json =
      jsonText({{"version", RP_VERSION}, {"image", arguments.scene.file()}, {"comparisons", list}});
  if (to_stdout) {
    std::cout << json;
    return kDone;
  }
  if (!arguments.json.empty()) writeFileAtomically(arguments.json, json);
  std::cout << text;
  return kDone;
}

}  // namespace

std::function<int()> declareCompare(CLI::App& command) {
  const auto arguments = std::make_shared<CompareArguments>();
  command.footer(kExamples);
  declareScene(command, arguments->scene);
  command.add_option("--paths", arguments->paths, "Paths to compare, the reference first")
      ->delimiter(',')
      ->check(CLI::IsMember({"host", "glsl", "cuda"}))
      ->capture_default_str();
  declareCuda(command, arguments->cuda);
  command.add_option("--starts", arguments->options.starts, "Start points of the search")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--threads", arguments->threads, "Of the host; 0: all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command
      .add_option(
          "--json", arguments->json, "Write the comparison as JSON; - is stdout, then without text")
      ->option_text("FILE|-");
  command
      .add_option("--picture",
                  arguments->picture,
                  "Write the stages of all paths side by side with their differences (PNG)")
      ->option_text("FILE");
  return [arguments] { return compare(*arguments); };
}

}  // namespace rangepose::cli
