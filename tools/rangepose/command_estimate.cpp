// rangepose estimate: one depth image, one cloud or one BOP data set in, poses out.
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "debug/dump.h"
#include "debug/overlay.h"
#include "io/atomic_file.h"
#include "pipeline/estimate.h"
#include "pipeline/path_choice.h"
#include "rangepose/bop_run.h"
#include "rangepose/command.h"
#include "rangepose/console.h"
#include "rangepose/cuda_options.h"
#include "rangepose/estimate_dump.h"
#include "rangepose/estimate_report.h"
#include "rangepose/picking_options.h"
#include "rangepose/progress.h"
#include "rangepose/scene_input.h"

namespace rangepose::cli {
namespace {

constexpr const char* kExamples =
    R"(Poses are model to camera, in mm; rotations are written as a quaternion (text) or as nine
numbers row by row (JSON). They come in the order in which to pick them: by score times freedom
(the share of a part above which nothing lies, seen along the bin's z axis, without --bin along the
camera's axis), in steps of a tenth; in a step the highest part first. With --workspace or
--min-freedom all parts are looked for and those out of reach left out.

Examples:
  rangepose estimate --db parts.rpdb --depth depth.png --camera camera.json
  rangepose estimate --db parts.rpdb --cloud scan.pcd --all --json poses.json --overlay seen.png
  rangepose estimate --db parts.rpdb --depth d.png --camera c.json --bin bin.json --json -
  rangepose estimate --db parts.rpdb --depth d.png --camera c.json --bin bin.json --all
                     --approach-cone 20 --min-freedom 0.6 --workspace -200 200 -150 150 0 300
  rangepose estimate --db lm.rpdb --bop lm --split test --csv results.csv --all)";

constexpr int kAllPoses = 100;

struct EstimateArguments {
  SceneArguments scene;
  BopArguments bop;
  std::string path = "auto";
  CudaArguments cuda;
  EstimateOptions options;
  PickingArguments picking;
  bool first = false;
  bool all = false;
  int max_poses = 0;  ///< 0: not given
  int threads = 0;
  std::string json;
  std::string overlay;
  std::string dump;
};

void checkUsage(const EstimateArguments& arguments, bool split_given) {
  const SceneArguments& scene = arguments.scene;
  if (arguments.first + arguments.all + (arguments.max_poses > 0) > 1) {
    throw UsageError("--first, --all and --max-poses exclude each other; give one of them");
  }
  if (arguments.bop.folder.empty()) {
    if (!arguments.bop.csv.empty() || split_given || arguments.bop.resume) {
      throw UsageError("--csv, --split and --resume belong to --bop DIR; use --json for one image");
    }
    checkScene(scene);
    return;
  }
  if (scene.given()) throw UsageError("--bop excludes --depth and --cloud; give one of them");
  if (arguments.bop.csv.empty()) throw UsageError("--bop needs --csv FILE");
  if (!scene.camera.empty() || !scene.bin.empty() || !scene.unit.empty()) {
    throw UsageError("--camera, --bin and --unit do not go with --bop: the data set has them");
  }
  if (!arguments.json.empty() || !arguments.overlay.empty() || !arguments.dump.empty()) {
    throw UsageError("--json, --overlay and --dump do not go with --bop; use --csv");
  }
  if (arguments.picking.given()) {
    throw UsageError(
        "--approach-cone, --min-freedom, --workspace and --arm do not go with --bop: its results "
        "are not ordered for picking");
  }
}

void checkOutputs(const EstimateArguments& arguments) {
  if (!arguments.bop.csv.empty()) checkOutputFile(arguments.bop.csv);
  if (!arguments.json.empty() && arguments.json != "-") checkOutputFile(arguments.json);
  if (!arguments.overlay.empty()) checkOutputFile(arguments.overlay);
}

void report(const EstimateArguments& arguments,
            const DepthImage& depth,
            const Estimate& estimate,
            const ReportContext& context) {
  for (const std::string& warning : estimate.warnings) printWarning(warning);
  const std::string text = textReport(estimate, context);
  const std::string json =
      arguments.json.empty() ? std::string() : jsonText(jsonReport(estimate, context));
  if (!arguments.overlay.empty()) {
    debug::writeOverlay(arguments.overlay, depth, overlayPoses(estimate, context.database));
  }
  if (arguments.json == "-") {
    std::cout << json;
    return;
  }
  if (!json.empty()) writeFileAtomically(arguments.json, json);
  std::cout << text;
}

int estimateScene(const EstimateArguments& arguments,
                  const ReferenceDatabase& database,
                  StageSet& stages) {
  const DepthImage depth = readScene(arguments.scene);
  const std::optional<BinBox> bin = readBin(arguments.scene);
  std::unique_ptr<debug::StageDump> dump;
  EstimateTrace trace;
  if (!arguments.dump.empty()) {
    dump = std::make_unique<debug::StageDump>(arguments.dump, arguments.scene.file());
    dump->addDepth(depth);
  }
  PickOptions picking = pickingOptions(arguments.picking);
  EstimateOptions options = arguments.options;
  if (arguments.picking.limited()) {
    // What is surest may be out of reach, so that the wanted ones are chosen from all.
    picking.max_picks = options.max_poses;
    options.max_poses = std::max(options.max_poses, kAllPoses);
  }
  Estimate estimate;
  std::vector<Pick> picks;
  {
    const Progress progress(std::cerr, "estimating", 0, terminalProgress());
    estimate = estimatePoses(depth, bin, database, options, stages, dump ? &trace : nullptr);
    const ScopedTimer timer(estimate.times, "picking order");
    picks = pickingOrder(estimate.poses, depth, estimate.noise_mm, bin, database, picking);
  }
  const std::size_t found = estimate.poses.size();
  keepPicks(estimate, picks);
  if (dump) finishDump(*dump, depth, database, estimate, trace);
  report(arguments,
         depth,
         estimate,
         {database, stages.name, arguments.scene.file(), options.min_score, picks, found});
  return kDone;
}

int estimate(EstimateArguments arguments, bool split_given) {
  checkUsage(arguments, split_given);
  static_cast<void>(pickingOptions(arguments.picking));  // bad values are told before the work
  if (arguments.all) arguments.options.max_poses = kAllPoses;
  if (arguments.max_poses > 0) arguments.options.max_poses = arguments.max_poses;
  checkOutputs(arguments);
  setThreadCount(arguments.threads);
  const PathStages path = openPath(parsePathRequest(arguments.path), cudaOptions(arguments.cuda));
  const ReferenceDatabase database = readDatabase(arguments.scene.database);
  if (!arguments.bop.folder.empty()) {
    return runBop(
        arguments.bop, arguments.scene.database, database, arguments.options, *path.stages);
  }
  return estimateScene(arguments, database, *path.stages);
}

void declareOutputs(CLI::App& command, EstimateArguments& arguments) {
  command
      .add_option(
          "--json", arguments.json, "Write the poses as JSON; - is stdout, then without text")
      ->option_text("FILE|-");
  command
      .add_option(
          "--overlay", arguments.overlay, "Write a picture of the poses over the image (PNG)")
      ->option_text("FILE");
  command
      .add_option(
          "--dump", arguments.dump, "Write pictures of all stages and a page to this folder")
      ->option_text("DIR");
  command.add_option("--csv", arguments.bop.csv, "Result file of --bop")->option_text("FILE");
  command.add_flag("--resume",
                   arguments.bop.resume,
                   "Go on with a run over --bop that was interrupted, from FILE.partial of --csv");
}

void declareSearch(CLI::App& command, EstimateArguments& arguments) {
  command
      .add_option("--path", arguments.path, "auto: cuda, else glsl on a hardware GPU, else host")
      ->check(CLI::IsMember({"auto", "glsl", "host", "cuda"}))
      ->capture_default_str();
  declareCuda(command, arguments.cuda);
  command
      .add_option("--starts",
                  arguments.options.starts,
                  "Start points of the search, of each pass where several poses are wanted "
                  "[3 for one pose; for several 40 of the first pass, 20 of those after it]")
      ->check(CLI::Range(1, 1000));
  command.add_flag("--first", arguments.first, "The best pose only (default)");
  command.add_flag(
      "--all", arguments.all, "All visible parts, at most " + std::to_string(kAllPoses));
  command.add_option("--max-poses", arguments.max_poses, "At most so many poses")
      ->check(CLI::Range(1, 10000));
  command
      .add_option("--min-score",
                  arguments.options.min_score,
                  "Poses less likely to be right are not reported")
      ->check(shareValidator())
      ->capture_default_str();
  command
      .add_option("--threads", arguments.threads, "Of the host; 0: all cores; no effect on results")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

}  // namespace

std::function<int()> declareEstimate(CLI::App& command) {
  const auto arguments = std::make_shared<EstimateArguments>();
  command.footer(kExamples);
  declareScene(command, arguments->scene);
  command.add_option("--bop", arguments->bop.folder, "All images of a BOP data set")
      ->option_text("DIR");
  const CLI::Option* split =
      command.add_option("--split", arguments->bop.split, "Of the data set")->capture_default_str();
  declareSearch(command, *arguments);
  declarePicking(command, arguments->picking);
  declareOutputs(command, *arguments);
  return [arguments, split] { return estimate(*arguments, split->count() > 0); };
}

}  // namespace rangepose::cli
