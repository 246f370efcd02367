#include "eval/paper_run.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "database/reference_database.h"
#include "io/mesh_file.h"
#include "pipeline/scene_window.h"
#include "sim/drop.h"
#include "stages/reference_host.h"

namespace rangepose {
namespace {

struct PaperPart {
  const char* name;
  int count;  ///< parts of a bin
};

constexpr PaperPart kParts[] = {{"t_pipe", 20}, {"bolt", 30}, {"elbow", 20}};
constexpr int kTypes = 3;
constexpr int kTimedEvery = 5;

VirtualBin dropBin(
    const PaperModel& model, const PhysicsPart& part, int count, int number, std::uint64_t seed) {
  DropOptions options;
  options.seed = seed + static_cast<std::uint64_t>(number);
  const DroppedBin dropped = dropParts({part}, {count}, options);
  VirtualBin bin;
  bin.mesh = &model.errors.mesh();
  bin.number = number;
  bin.inner_mm = dropped.bin.inner_mm;
  for (const PlacedPart& placed : dropped.parts) {
    bin.bin_from_object.push_back(placed.world_from_object);
  }
  return bin;
}

/// The hypothesis that the paper answers: the arg min over views and starts.
std::optional<Pose> bestOfSearch(const ReferenceObject& object, const ObjectTrace& trace) {
  const Hypothesis* best = lowestError(trace);
  if (best == nullptr || best->error >= kWorstError) return std::nullopt;
  return poseOf(*best, object, trace.windows[static_cast<std::size_t>(best->window)].camera);
}

std::optional<Pose> bestOfUnlimitedSearch(const BinScan& scan,
                                          const ReferenceDatabase& database,
                                          EstimateOptions options,
                                          StageSet& stages) {
  options.search.error.range_limit_px = kNoRangeLimit;
  options.kept_per_start = options.verified = 1;  // what follows the search is not asked for
  EstimateTrace trace;
  estimatePoses(scan.image, scan.bin, database, options, stages, &trace);
  return bestOfSearch(database.objects.front(), trace.objects.front());
}

}  // namespace

PaperModels paperModels(const std::filesystem::path& models,
                        int bins,
                        std::uint64_t seed,
                        const std::function<void(int done, int total)>& progress) {
  RP_CHECK(bins >= 1 && bins <= 999, "the number of bins must lie in 1..999");
  PaperModels made;
  int done = 0;
  for (int type = 0; type < std::min(bins, kTypes); ++type) {
    const PaperPart& part = kParts[type];
    const std::filesystem::path path = models / (std::string(part.name) + ".ply");
    const Mesh mesh = readMesh(path, LengthUnit::kMillimetre);
    auto model = std::make_unique<PaperModel>(mesh, findSymmetries(mesh));
    model->name = part.name;
    model->mesh_path = path;
    const PhysicsPart physics = physicsPart(mesh);
    for (int number = type; number < bins; number += kTypes) {
      model->bins.push_back(dropBin(*model, physics, part.count, number, seed));
      if (progress) progress(++done, bins);
    }
    made.push_back(std::move(model));
  }
  return made;
}

int trialCount(const PaperModels& models) {
  std::size_t count = 0;
  for (const auto& model : models) {
    for (const VirtualBin& bin : model->bins) count += bin.bin_from_object.size();
  }
  return static_cast<int>(count);
}

ReferenceDatabase referencesOf(const PaperModel& model,
                               int size,
                               const std::vector<glm::dmat3>& views) {
  const ChannelOptions channels = channelOptionsFor(size);
  ReferenceDatabase database;
  database.objects.push_back(describeObject(model.errors.mesh(), 1, size, views, channels));
  database.objects.front().symmetries = model.errors.symmetries();
  host::renderReferences(database.objects.front(), channels, {});
  return database;
}

TrialAnswer answerOf(const BinScan& scan,
                     const ReferenceDatabase& database,
                     const EstimateOptions& options,
                     StageSet& stages,
                     bool timed) {
  EstimateTrace trace;
  const Estimate estimate = estimatePoses(scan.image, scan.bin, database, options, stages, &trace);
  TrialAnswer answer;
  answer.search = bestOfSearch(database.objects.front(), trace.objects.front());
  answer.unlimited = bestOfUnlimitedSearch(scan, database, options, stages);
  if (!trace.coarse.empty()) answer.rough = trace.coarse.front().pose;
  if (!estimate.poses.empty()) {
    const PoseEstimate& first = estimate.poses.front();
    answer.fine = first.pose;
    answer.score = first.confidence;
  }
  if (timed) {
    answer.times = estimatePoses(scan.image, scan.bin, database, options, stages).times;
  }
  return answer;
}

ModelRun runModel(const PaperModel& model,
                  const ReferenceDatabase& database,
                  const EstimateOptions& options,
                  const BinScanOptions& scan_options,
                  StageSet& stages,
                  const TrialObserver& observe) {
  constexpr double kBytesPerMb = 1.0e6;
  ModelRun run;
  run.model = model.name;
  run.atlas_mb =
      static_cast<double>(database.objects.front().atlas.size() * sizeof(ReferenceTexel)) /
      kBytesPerMb;
  int done = 0;
  const auto answer = [&](const BinScan& scan) {
    return answerOf(scan, database, options, stages, done++ % kTimedEvery == 0);
  };
  for (const VirtualBin& bin : model.bins) {
    const std::vector<Trial> trials = emptyBin(bin, model.errors, scan_options, answer, observe);
    run.trials.insert(run.trials.end(), trials.begin(), trials.end());
  }
  return run;
}

}  // namespace rangepose
