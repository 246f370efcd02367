#include "pipeline/estimate.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/foreground_task.h"
#include "pipeline/input_warnings.h"
#include "pipeline/refine.h"
#include "pipeline/scene_window.h"
#include "pipeline/selection.h"
#include "stages/sensor_facts_host.h"

namespace rangepose {
namespace {

/// A scene image has at most this many pixels along a side; larger scenes are looked at more
/// coarsely to find starts, never for the search itself.
constexpr int kMaxScenePx = 1024;
/// A start this near to an earlier one would find what that found [share of the diameter].
constexpr double kTriedApart = 0.1;
constexpr int kFruitlessPasses = 2;

PoseEstimate estimateOf(const Candidate& candidate) {
  return {candidate.object,
          candidate.rough,
          candidate.pose,
          candidate.rough_error,
          candidate.view,
          candidate.confidence,
          candidate.check,
          candidate.evidence};
}

/// The windows around the starts of one object, and what they were made of.
struct Windows {
  ResidentScenes scenes;
  std::vector<OrthoCamera> cameras;
  std::vector<float> seed_range_px;
};

/// What one pass over a scene gives.
struct Pass {
  std::vector<Candidate> checked;  ///< a few of each start, surest first
  int starts = 0;                  ///< of all objects
};

class Estimator {
 public:
  /// Noise and background of the image are in `result`.
  Estimator(const ResidentForeground& scene,
            const std::optional<BinBox>& bin,
            const ReferenceDatabase& database,
            const EstimateOptions& options,
            StageSet& stages,
            Estimate& result)
      : depth_(scene.on_host.depth),
        whole_(*scene.resident),
        database_(database),
        options_(options),
        stages_(stages),
        result_(result),
        enclosure_(depth_, result.background, bin, database, result.noise_mm),
        tried_(database.objects.size()) {}

  /// Sect. 5 to 7 on what is left of the foreground, from starts that were not tried before.
  /// Poses that are known already are not checked again.
  Pass onePass(const Image<std::uint8_t>& foreground,
               const Selection& known,
               EstimateTrace* trace) {
    const PassEffort effort = options_.effort(passes_);
    // What was looked at quickly may be looked at once more.
    if (passes_ == 1) tried_.assign(database_.objects.size(), {});
    ++passes_;
    // Nothing is taken out before the first pass.
    const std::unique_ptr<ResidentDepth> left =
        passes_ > 1 ? stages_.foreground->upload(depth_, foreground) : nullptr;
    const ResidentDepth& resident = left ? *left : whole_;
    const RefineScene scene{
        depth_, resident, result_.noise_mm, enclosure_, stages_, options_.align};
    const LateralExtent extent = extentOf(resident);
    Pass pass;
    std::vector<Candidate>& candidates = pass.checked;
    for (std::size_t i = 0; i < database_.objects.size(); ++i) {
      const ReferenceObject& object = database_.objects[i];
      ObjectTrace* object_trace = trace != nullptr ? &trace->objects.emplace_back() : nullptr;
      const std::vector<glm::dvec3> starts =
          findStarts(object, foreground, resident, extent, tried_[i], effort.starts, object_trace);
      tried_[i].insert(tried_[i].end(), starts.begin(), starts.end());
      pass.starts += static_cast<int>(starts.size());
      const Windows windows = cutWindows(object, resident, starts, object_trace);
      const std::vector<Hypothesis> hypotheses = search(object, windows, effort, object_trace);
      const ScopedTimer timer(result_.times, "select");
      const std::vector<Candidate> own = bestCandidates(
          object, static_cast<int>(i), hypotheses, windows.cameras, scene, effort.kept);
      candidates.insert(candidates.end(), own.begin(), own.end());
    }
    {
      const ScopedTimer timer(result_.times, "coarse icp");
      candidates = refineCoarsely(std::move(candidates), database_, scene, effort.verified);
      std::erase_if(candidates, [&](const Candidate& one) { return known.knows(one); });
    }
    if (trace != nullptr) {
      for (const Candidate& candidate : candidates) trace->coarse.push_back(estimateOf(candidate));
    }
    const ScopedTimer timer(result_.times, "fine icp and check");
    refineFinely(candidates, database_, scene, effort.fine);
    std::stable_sort(candidates.begin(),
                     candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
    if (trace != nullptr) {
      for (const Candidate& candidate : candidates)
        trace->verified.push_back(estimateOf(candidate));
    }
    return pass;
  }

  /// Aligns and checks turned copies of poses on all of the foreground; none that is known already.
  std::vector<Candidate> alignTurned(std::vector<Candidate> copies, const Selection& known) {
    constexpr int kVerified = 2;  // of the copies of a pose
    if (copies.empty()) return copies;
    const ScopedTimer timer(result_.times, "turned copies");
    const RefineScene scene = wholeScene();
    copies = refineTurned(copies, database_, scene, kVerified);
    std::erase_if(copies, [&](const Candidate& one) { return known.knows(one); });
    FineEffort effort = options_.effort(passes_ - 1).fine;
    effort.rounds = 1;
    effort.finalists = 2;
    refineFinely(copies, database_, scene, effort);
    return copies;
  }

  /// Adds poses that what is seen hardly tells from the chosen ones, as it leaves these free to
  /// turn: the search may have come to rest at any of them.
  void turnFree(Selection& selection) {
    const ScopedTimer timer(result_.times, "free turns");
    std::vector<Candidate> turns = selection.freeTurnsOfChosen();
    if (turns.empty()) return;
    checkFreeTurns(turns, database_, wholeScene());
    std::erase_if(turns, [&](const Candidate& one) { return selection.knows(one); });
    selection.add(turns);
  }

  /// Brings the chosen poses to rest, after a closer look at those that are as likely as their
  /// rivals, or nearly, and at these.
  void settleChosen(Selection& selection) {
    const ScopedTimer timer(result_.times, "settle");
    const RefineScene scene = wholeScene();
    std::vector<Candidate> candidates = selection.takeTies();
    refineTies(candidates, database_, scene);
    const std::vector<Candidate> others = selection.takeChosen();
    candidates.insert(candidates.end(), others.begin(), others.end());
    settle(candidates, database_, scene);
    selection.add(candidates);
    std::vector<Candidate> twins = selection.twinsOfChosen();
    if (twins.empty()) return;
    checkTwins(twins, database_, scene);
    selection.addTwins(twins);
  }

 private:
  RefineScene wholeScene() const {
    return {depth_, whole_, result_.noise_mm, enclosure_, stages_, options_.align};
  }

  LateralExtent extentOf(const ResidentDepth& resident) {
    const ScopedTimer timer(result_.times, "scene and starts");
    return stages_.foreground->extent(resident);
  }

  /// The start points, in the camera frame [mm]; none near those in `tried`.
  std::vector<glm::dvec3> findStarts(const ReferenceObject& object,
                                     const Image<std::uint8_t>& foreground,
                                     const ResidentDepth& resident,
                                     const LateralExtent& extent,
                                     const std::vector<glm::dvec3>& tried,
                                     int wanted,
                                     ObjectTrace* trace) {
    const ScopedTimer timer(result_.times, "scene and starts");
    const OrthoCamera camera = sceneCamera(extent, object.pixel_mm, kMaxScenePx);
    if (camera.width == 0) return {};
    // Twice the passes of a reference, as the paper's 15 at 128 px for 7 at 64 px.
    ChannelOptions channel_options = channelOptionsOf(object);
    channel_options.edt_passes = 2 * object.edt_passes + 1;
    const ResidentScenes scene = stages_.scenes->prepare(resident, {{camera, {}}}, channel_options);
    const SceneChannels channels = scene.front()->download();
    const Image<std::int32_t> labels = stages_.scenes->patches(*scene.front());
    const int count = wanted + static_cast<int>(tried.size());
    const std::vector<Seed> seeds = findSeeds(channels, labels, seedOptions(object, camera, count));
    if (trace != nullptr) {
      trace->raw_range_px = stages_.probe->resample(depth_, foreground, camera);
      trace->scene = channels;
      trace->labels = labels;
      trace->seeds = seeds;
      trace->scene_options = channel_options;
    }
    std::vector<glm::dvec3> points;
    const double apart_mm = kTriedApart * object.diameter_mm;
    for (const Seed& seed : seeds) {
      const glm::dvec3 point =
          camera.camera_from_ortho * camera.orthoFromPixel(seed.x_px, seed.y_px, seed.range_px);
      const bool known = std::any_of(tried.begin(), tried.end(), [&](const glm::dvec3& other) {
        return glm::distance(point, other) < apart_mm;
      });
      if (!known) points.push_back(point);
      if (static_cast<int>(points.size()) >= wanted) break;
    }
    return points;
  }

  static SeedOptions seedOptions(const ReferenceObject& object,
                                 const OrthoCamera& camera,
                                 int count) {
    const double area = object.meanArea();
    const double scale = object.pixel_mm / camera.pixel_mm;
    SeedOptions seed_options;
    seed_options.count = count;
    seed_options.min_patch_px = static_cast<int>(0.08 * area * scale * scale);
    seed_options.max_patch_px =
        static_cast<int>(1.2 * static_cast<double>(object.maxArea()) * scale * scale);
    seed_options.apart_px = static_cast<float>(0.4 * object.diameter_mm / camera.pixel_mm);
    return seed_options;
  }

  Windows cutWindows(const ReferenceObject& object,
                     const ResidentDepth& resident,
                     const std::vector<glm::dvec3>& starts,
                     ObjectTrace* trace) {
    const ScopedTimer timer(result_.times, "windows");
    Windows windows;
    const int width = kWindowScale * object.size;
    std::vector<WindowTask> tasks;
    for (const glm::dvec3& point : starts) {
      const OrthoCamera camera = windowCamera(depth_.camera, point, width, object.pixel_mm);
      tasks.push_back({camera, windowRegion(depth_.camera, point, width, object.pixel_mm)});
      windows.cameras.push_back(camera);
      const glm::dvec3 in_window = camera.camera_from_ortho.inverse() * point;
      windows.seed_range_px.push_back(static_cast<float>(in_window.z / object.pixel_mm));
    }
    windows.scenes = stages_.scenes->prepare(resident, tasks, channelOptionsOf(object));
    if (trace == nullptr) return windows;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      trace->windows.push_back(windows.scenes[i]->download());
      trace->window_regions.push_back(tasks[i].region);
    }
    trace->seed_range_px = windows.seed_range_px;
    return windows;
  }

  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const Windows& windows,
                                 const PassEffort& effort,
                                 ObjectTrace* trace) {
    const ScopedTimer timer(result_.times, "rough search");
    SearchOptions search_options = options_.search;
    search_options.error.image_width_px = object.size;
    search_options.simplex.max_iterations = effort.iterations;
    search_options.error.row_step = effort.row_step;
    std::vector<const ResidentScene*> scenes;
    for (const auto& scene : windows.scenes) scenes.push_back(scene.get());
    std::vector<Hypothesis> hypotheses =
        stages_.search->search(object, scenes, windows.seed_range_px, search_options);
    if (trace != nullptr) {
      trace->hypotheses = hypotheses;
      trace->search = search_options;
    }
    return hypotheses;
  }

  const DepthImage& depth_;
  const ResidentDepth& whole_;  ///< with all of the foreground
  const ReferenceDatabase& database_;
  const EstimateOptions& options_;
  StageSet& stages_;
  Estimate& result_;
  Enclosure enclosure_;
  int passes_ = 0;
  std::vector<std::vector<glm::dvec3>> tried_;  ///< starts of each object so far
};

}  // namespace

PassEffort EstimateOptions::effort(int pass) const {
  // One pose must come from what three starts give, the paper's N_init. Several poses: first a
  // quick look everywhere, then a closer one at what is left, each with half of a view's rows: the
  // alignment finds what that leaves.
  const int most = search.simplex.max_iterations;
  const PassEffort one{3, most, 1, 256, 16, {2, 900, 3, 1e-4}};
  constexpr PassEffort kQuick{40, 30, 2, 160, 4, {1, 450, 2, 1e-3}};
  constexpr PassEffort kClose{20, 40, 2, 256, 12, {1, 450, 3, 1e-3}};
  PassEffort result = max_poses == 1 ? one : pass == 0 ? kQuick : kClose;
  result.iterations = std::min(result.iterations, most);
  result.row_step = std::max(result.row_step, search.error.row_step);
  if (starts > 0) result.starts = starts;
  if (kept_per_start > 0) result.kept = kept_per_start;
  if (verified > 0) result.verified = verified;
  return result;
}

void EstimateOptions::check() const {
  RP_CHECK(starts >= 0 && starts <= 1000, "starts must lie in 1..1000, or be 0 for the default");
  RP_CHECK(kept_per_start >= 0, "kept_per_start must be at least 1, or 0 for the default");
  RP_CHECK(verified >= 0, "verified must be at least 1, or 0 for the default");
  RP_CHECK(max_poses >= 1, "max_poses must be at least 1");
  RP_CHECK(min_score >= 0.0 && min_score <= 1.0, "min_score must lie in 0..1");
  align.check();
  choice.check();
  search.simplex.check();
  search.error.check();
}

const Hypothesis* lowestError(const ObjectTrace& trace) {
  const auto best =
      std::min_element(trace.hypotheses.begin(),
                       trace.hypotheses.end(),
                       [](const Hypothesis& a, const Hypothesis& b) { return a.error < b.error; });
  return best == trace.hypotheses.end() ? nullptr : &*best;
}

Estimate estimatePoses(const DepthImage& measured,
                       const std::optional<BinBox>& bin,
                       const ReferenceDatabase& database,
                       const EstimateOptions& options,
                       StageSet& stages,
                       EstimateTrace* trace) {
  EstimateTrace* first_trace = trace;
  options.check();
  measured.camera.check();
  RP_CHECK(!database.objects.empty(), "the database holds no object");
  RP_CHECK(measured.depth_mm.width() == measured.camera.width &&
               measured.depth_mm.height() == measured.camera.height,
           "depth image and camera differ in size");
  if (std::none_of(
          measured.depth_mm.begin(), measured.depth_mm.end(), [](float mm) { return mm > 0.0f; })) {
    throw Error("the depth image has no measured pixel; check the file and its depth_scale");
  }
  Estimate result;
  result.warnings = unitWarnings(measured, database);
  if (bin) {
    const std::vector<std::string> of_bin = binWarnings(measured, *bin, database);
    result.warnings.insert(result.warnings.end(), of_bin.begin(), of_bin.end());
  }
  std::unique_ptr<ResidentForeground> scene;
  {
    const ScopedTimer timer(result.times, "foreground");
    scene = stages.foreground->find(measured, foregroundTaskFor(database, bin));
    result.sensor = host::sensorFacts(measured, scene->on_host.noise_mm);
    if (measured.camera.error_mm > 0.0) result.sensor.error_mm = measured.camera.error_mm;
  }
  const Foreground& on_host = scene->on_host;
  result.noise_mm = result.sensor.error_mm;
  result.background = on_host.background;
  if (trace != nullptr) trace->foreground = on_host.mask;
  Estimator estimator(*scene, bin, database, options, stages, result);
  Selection selection(on_host.depth, database, result.noise_mm, options.choice);
  Image<std::uint8_t> rest = on_host.mask;
  int found = 0;
  // Passes on what is left, until all its starts were tried before, or two found nothing.
  for (int fruitless = 0; fruitless < kFruitlessPasses;) {
    const Pass pass = estimator.onePass(rest, selection, first_trace);
    first_trace = nullptr;
    std::vector<Candidate> copies;
    {
      const ScopedTimer timer(result.times, "selection");
      selection.add(pass.checked);
      copies = selection.turnedCopies();
    }
    copies = estimator.alignTurned(std::move(copies), selection);
    const ScopedTimer timer(result.times, "selection");
    selection.add(copies);
    const int before = found;
    const std::vector<Candidate> chosen = selection.choose();
    found = static_cast<int>(std::count_if(chosen.begin(), chosen.end(), [&](const Candidate& one) {
      return one.confidence >= options.choice.found;
    }));
    const bool enough = found >= options.max_poses;
    if (pass.starts == 0 || enough || options.max_poses == 1) break;
    rest = on_host.mask;
    selection.takeOut(rest);
    fruitless = found > before ? 0 : fruitless + 1;
  }
  estimator.turnFree(selection);
  estimator.settleChosen(selection);
  const std::vector<Candidate> chosen = selection.choose();
  if (trace != nullptr) {
    trace->known = selection.known();
    trace->chosen = chosen;
  }
  for (const Candidate& candidate : chosen) {
    if (static_cast<int>(result.poses.size()) >= options.max_poses) break;
    if (!(candidate.confidence >= options.min_score)) break;
    result.poses.push_back(estimateOf(candidate));
  }
  return result;
}

}  // namespace rangepose
