// Trials with a known answer: one part of models/ in a random pose, rendered with sensor noise,
// partly hidden if wanted. Prints how often the pose is right, as Markdown; with --ablation for one
// changed option after the other.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "eval/ablation.h"
#include "eval/pose_errors.h"
#include "eval/pose_trial.h"
#include "geometry/orientation_grid.h"
#include "io/mesh_file.h"
#include "pipeline/estimate.h"
#include "pipeline/scene_window.h"
#include "sim/sensor_model.h"
#include "stages/reference_host.h"

namespace rangepose {
namespace {

constexpr double kRightRough = 0.10;  // vertex error as a share of the diameter, as in the paper
constexpr double kRightFine = 0.02;

struct Part {
  std::string name;
  ReferenceDatabase database;
  ErrorModel errors;
};

struct TrialOptions {
  std::string models = "models";
  int views = 1024;
  int trials = 25;
  std::uint64_t seed = 3000;
  std::string sensor = "structured-light";
  double hidden = 0.0;
};

struct Result {
  int trials = 0;
  int rough = 0;
  int fine = 0;
  std::vector<double> errors;  ///< of the refined poses, shares of the diameter
};

std::vector<Part> loadParts(const TrialOptions& options) {
  constexpr int kSize = 64;
  std::vector<Part> parts;
  for (const std::string name : {"t_pipe", "bolt", "elbow", "bracket"}) {
    const Mesh mesh = readMesh(options.models + "/" + name + ".ply", LengthUnit::kMillimetre);
    const ChannelOptions channels = channelOptionsFor(kSize);
    const Symmetries symmetries = findSymmetries(mesh);
    Part part{name, {}, ErrorModel(mesh, symmetries)};
    part.database.objects.push_back(
        describeObject(mesh, 1, kSize, uniformRotations(options.views), channels));
    host::renderReferences(part.database.objects.front(), channels, {});
    setSymmetries(part.database.objects.front(), symmetries);
    parts.push_back(std::move(part));
  }
  return parts;
}

/// Vertex error of the hypothesis with the lowest Eq. 1, as a share of the diameter.
double roughError(const ObjectTrace& trace, const Part& part, const Pose& truth) {
  const Hypothesis* best = lowestError(trace);
  if (best == nullptr) return std::numeric_limits<double>::infinity();
  const ReferenceObject& object = part.database.objects.front();
  const OrthoCamera& window = trace.windows[static_cast<std::size_t>(best->window)].camera;
  return vertexErrorMm(part.errors, poseOf(*best, object, window), truth) / object.diameter_mm;
}

Result runTrials(const Part& part,
                 const TrialOptions& options,
                 const EstimateOptions& estimate_options,
                 StageSet& stages) {
  Result result;
  const ReferenceObject& object = part.database.objects.front();
  for (int i = 0; i < options.trials; ++i) {
    const PoseTrial trial = makePoseTrial(
        object.mesh, options.seed + static_cast<std::uint64_t>(i), options.sensor, options.hidden);
    EstimateTrace trace;
    const Estimate estimate =
        estimatePoses(trial.image, std::nullopt, part.database, estimate_options, stages, &trace);
    double error = std::numeric_limits<double>::infinity();
    if (!estimate.poses.empty()) {
      error = vertexErrorMm(part.errors, estimate.poses.front().pose, trial.camera_from_object) /
              object.diameter_mm;
    }
    ++result.trials;
    result.fine += error < kRightFine ? 1 : 0;
    result.rough +=
        roughError(trace.objects.front(), part, trial.camera_from_object) < kRightRough ? 1 : 0;
    result.errors.push_back(error);
  }
  return result;
}

void add(Result& sum, const Result& more) {
  sum.trials += more.trials;
  sum.rough += more.rough;
  sum.fine += more.fine;
  sum.errors.insert(sum.errors.end(), more.errors.begin(), more.errors.end());
}

void printRow(const std::string& name, Result result) {
  std::sort(result.errors.begin(), result.errors.end());
  const double all = result.trials;
  fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.3f} | {:.3f} |\n",
             name,
             result.trials,
             100.0 * result.rough / all,
             100.0 * result.fine / all,
             100.0 * result.errors[result.errors.size() / 2],
             100.0 * result.errors[result.errors.size() * 9 / 10]);
  std::fflush(stdout);
}

Result runAll(const std::vector<Part>& parts,
              const TrialOptions& options,
              const EstimateOptions& estimate_options,
              StageSet& stages,
              bool print_parts) {
  Result sum;
  for (const Part& part : parts) {
    const Result result = runTrials(part, options, estimate_options, stages);
    if (print_parts) printRow(part.name, result);
    add(sum, result);
  }
  return sum;
}

void run(const TrialOptions& options, bool ablation) {
  const std::vector<Part> parts = loadParts(options);
  const std::unique_ptr<StageSet> stages = makeHostStages();
  EstimateOptions estimate_options;
  estimate_options.min_score = 0.0;
  fmt::print("{} views, seeds from {}, sensor {}, {:.0f} % hidden\n\n",
             options.views,
             options.seed,
             options.sensor,
             100.0 * options.hidden);
  fmt::print(
      "| {} | trials | rough < 10 % [%] | refined < 2 % [%] | median error [% of diameter] | 90th "
      "percentile |\n",
      ablation ? "changed" : "part");
  fmt::print("|---|---|---|---|---|---|\n");
  if (!ablation) {
    printRow("all", runAll(parts, options, estimate_options, *stages, true));
    return;
  }
  for (const AblationRow& row : ablationRows()) {
    if (row.size > 0 || row.scan_mm > 0.0) continue;  // `rangepose evaluate` has those
    EstimateOptions changed = estimate_options;
    row.change(changed);
    printRow(row.name, runAll(parts, options, changed, *stages, false));
  }
}

}  // namespace
}  // namespace rangepose

int main(int argc, char** argv) try {
  CLI::App app{"Pose trials with a known answer on the parts of models/, as a Markdown table"};
  rangepose::TrialOptions options;
  bool ablation = false;
  app.add_option("--models", options.models, "Folder of the parts")->capture_default_str();
  app.add_option("--views", options.views, "Views of a part")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  app.add_option("--trials", options.trials, "Trials a part")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of the first trial; the others follow")
      ->capture_default_str();
  app.add_option("--sensor", options.sensor, "What takes the images")
      ->check(CLI::IsMember(rangepose::sensorNames()))
      ->capture_default_str();
  app.add_option("--hidden", options.hidden, "Share of the part that is hidden")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  app.add_flag("--ablation", ablation, "One row for each changed option of the search");
  app.footer("Example: rangepose_trials --trials 50 --seed 20000 --hidden 0.4");
  CLI11_PARSE(app, argc, argv);
  rangepose::run(options, ablation);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "rangepose_trials: %s\n", error.what());
  return 1;
}
