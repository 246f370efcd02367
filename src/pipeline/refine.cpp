#include "pipeline/refine.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "pipeline/candidates.h"
#include "pipeline/pose_distance.h"

namespace rangepose {
namespace {

constexpr int kCandidatesPerPiece = 16;

using ViewsOfObjects = std::vector<std::shared_ptr<const ViewPoints>>;  ///< by object

const ReferenceObject& objectOf(const Candidate& candidate, const ReferenceDatabase& database) {
  return database.objects[static_cast<std::size_t>(candidate.object)];
}

IcpOptions icpOptions(double first_reach_mm, double last_reach_mm, int iterations) {
  IcpOptions options;
  options.iterations = iterations;
  options.last_reach_mm = last_reach_mm;
  options.first_reach_mm = std::max(first_reach_mm, last_reach_mm);
  return options;
}

/// Calls `set(candidate, verdict, mean visible area)` for each.
template <typename Set>
void setVerdicts(std::vector<Candidate>& candidates,
                 const std::vector<CheckResult>& verdicts,
                 const ReferenceDatabase& database,
                 const Set& set) {
  std::vector<double> mean_mm2;
  for (const ReferenceObject& object : database.objects)
    mean_mm2.push_back(meanVisibleArea(object));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto object = static_cast<std::size_t>(candidates[i].object);
    set(candidates[i], verdicts[i], mean_mm2[object]);
  }
}

/// Of the candidates' own views at least.
ViewsOfObjects pointsOfViews(const std::vector<Candidate>& candidates,
                             const ReferenceDatabase& database,
                             StageSet& stages,
                             int max_points) {
  std::vector<std::vector<int>> views(database.objects.size());
  for (const Candidate& candidate : candidates)
    views[static_cast<std::size_t>(candidate.object)].push_back(candidate.view);
  ViewsOfObjects points;
  for (std::size_t i = 0; i < views.size(); ++i)
    points.push_back(stages.points_of_views.of(database.objects[i], max_points, views[i]));
  return points;
}

/// By points of the candidates' own views, with a share of the tolerance.
void judgeWithViews(std::vector<Candidate>& candidates,
                    const ReferenceDatabase& database,
                    const RefineScene& scene,
                    const ViewsOfObjects& points,
                    double judged) {
  std::vector<JudgeTask> tasks;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const ReferenceObject& object = objectOf(candidates[i], database);
    CheckOptions options = checkOptionsFor(object, scene.noise_mm);
    options.tolerance_mm *= judged;
    const ViewPoints& views = *points[static_cast<std::size_t>(candidates[i].object)];
    const int view = candidates[i].view;
    tasks.push_back({&views.of[static_cast<std::size_t>(view)],
                     candidates[i].pose,
                     visibleArea(object, view),
                     options,
                     views.nameOf(view)});
  }
  setVerdicts(candidates, scene.stages.refine->judge(scene.resident, tasks), database, setVerdict);
}

void alignWithViews(std::vector<Candidate>& candidates,
                    const ReferenceDatabase& database,
                    const RefineScene& scene,
                    const ViewsOfObjects& points,
                    const CoarseRound& round) {
  std::vector<AlignTask> alignments;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const ReferenceObject& object = objectOf(candidates[i], database);
    IcpOptions options = icpOptions(round.first_reach * object.diameter_mm,
                                    round.last_tolerances * toleranceFor(object, scene.noise_mm),
                                    round.iterations);
    options.search_steps = round.search_steps;
    options.rim_reach_mm = round.rim_reach * object.diameter_mm;
    options.rim_weight = scene.align.coarse_rims;
    options.rim_steps = round.rim_steps;
    const ViewPoints& views = *points[static_cast<std::size_t>(candidates[i].object)];
    const int view = candidates[i].view;
    alignments.push_back({&views.of[static_cast<std::size_t>(view)],
                          candidates[i].pose,
                          object.center_mm,
                          object.radius_mm,
                          options,
                          views.nameOf(view)});
  }
  const std::vector<IcpResult> aligned = scene.stages.refine->align(scene.resident, alignments);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    candidates[i].pose = aligned[i].camera_from_object;
  judgeWithViews(candidates, database, scene, points, round.judged);
}

int mostOfAStart(const std::vector<Candidate>& candidates) {
  std::map<std::pair<int, int>, int> counts;
  int most = 0;
  for (const Candidate& one : candidates) most = std::max(most, ++counts[{one.object, one.window}]);
  return most;
}

}  // namespace

std::vector<Candidate> refineCoarsely(std::vector<Candidate> candidates,
                                      const ReferenceDatabase& database,
                                      const RefineScene& scene,
                                      int count) {
  constexpr int kPerMany = 2;  // of all
  constexpr int kFewPerKept = 3;
  const auto pointsOf = [&](int max_points) {
    return pointsOfViews(candidates, database, scene.stages, max_points);
  };
  alignWithViews(candidates, database, scene, pointsOf(kFewPoints), scene.align.all);
  const int many = std::max(mostOfAStart(candidates) / kPerMany, kFewPerKept * count);
  candidates = bestDistinct(std::move(candidates), database, many);
  alignWithViews(candidates, database, scene, pointsOf(kFewPoints), scene.align.many);
  std::erase_if(candidates, [&](const Candidate& one) {
    return !scene.enclosure.holds(one.object, one.pose, 0.0);
  });
  candidates = bestDistinct(std::move(candidates), database, kFewPerKept * count);
  alignWithViews(candidates, database, scene, pointsOf(scene.align.view_points), scene.align.few);
  return bestDistinct(std::move(candidates), database, count);
}

std::vector<Candidate> refineTurned(const std::vector<Candidate>& copies,
                                    const ReferenceDatabase& database,
                                    const RefineScene& scene,
                                    int count) {
  std::vector<Candidate> candidates = copies;
  judgeWithViews(candidates,
                 database,
                 scene,
                 pointsOfViews(candidates, database, scene.stages, scene.align.view_points),
                 scene.align.few.judged);
  const std::vector<Candidate> aligned = refineCoarsely(copies, database, scene, count);
  candidates.insert(candidates.end(), aligned.begin(), aligned.end());
  std::erase_if(candidates, [&](const Candidate& one) {
    return !scene.enclosure.holds(one.object, one.pose, 0.0);
  });
  return bestDistinct(std::move(candidates), database, count);
}

namespace {

/// Aligns what is visible of the candidates that move, and gives those that moved still.
std::vector<std::size_t> alignSurfaces(std::vector<Candidate>& candidates,
                                       const std::vector<std::size_t>& moving,
                                       const ReferenceDatabase& database,
                                       const RefineScene& scene,
                                       const FineRounds& fine,
                                       double still,
                                       double reach_tolerances) {
  // Faces alone leave a plate free to slide in its plane; where rims hold it, a pull towards the
  // nearest points would only slow it down.
  std::vector<RenderTask> tasks;
  for (const std::size_t i : moving) {
    const ReferenceObject& object = objectOf(candidates[i], database);
    const double tolerance = toleranceFor(object, scene.noise_mm);
    RenderTask& task = tasks.emplace_back(
        surfaceTask(object, candidates[i].pose, scene.depth.camera, scene.noise_mm));
    task.max_points = fine.points;
    task.alignment = icpOptions(
        reach_tolerances * tolerance, fine.last_reach * tolerance, scene.align.fine_iterations);
    task.alignment.search_steps = reach_tolerances > scene.align.nearly_right ? 2 : 1;
    task.alignment.slide = 0.0;
    task.alignment.rim_reach_mm = fine.rim_reach * object.diameter_mm;
  }
  const std::vector<IcpResult> aligned = scene.stages.refine->alignSurfaces(scene.resident, tasks);
  std::vector<std::size_t> still_moving;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    Candidate& candidate = candidates[moving[i]];
    const Pose before = std::exchange(candidate.pose, aligned[i].camera_from_object);
    const double moved = PoseDistance(objectOf(candidate, database))(before, candidate.pose);
    if (!(moved < still)) still_moving.push_back(moving[i]);
  }
  return still_moving;
}

void checkAll(std::vector<Candidate>& candidates,
              const ReferenceDatabase& database,
              const RefineScene& scene) {
  std::vector<RenderTask> tasks;
  tasks.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    tasks.push_back(surfaceTask(
        objectOf(candidate, database), candidate.pose, scene.depth.camera, scene.noise_mm));
  }
  parallelForEach(candidates.size(), kCandidatesPerPiece, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    candidate.outside = scene.enclosure.outsideShare(candidate.object, candidate.pose);
  });
  setVerdicts(
      candidates, scene.stages.refine->judgeSurfaces(scene.resident, tasks), database, setEvidence);
}

/// Aligns all until they rest, moving by less than `still` [diameters] in a round, then checks
/// them.
void refineAll(std::vector<Candidate>& candidates,
               const ReferenceDatabase& database,
               const RefineScene& scene,
               const FineRounds& fine,
               double still) {
  std::vector<std::size_t> moving(candidates.size());
  std::iota(moving.begin(), moving.end(), std::size_t{0});
  for (int round = 0; round < fine.rounds && !moving.empty(); ++round) {
    const double reach = round == 0 ? fine.first_reach : scene.align.later_reach;
    moving = alignSurfaces(candidates, moving, database, scene, fine, still, reach);
  }
  checkAll(candidates, database, scene);
}

/// Where little holds a pose, it may drift off: then it stays.
template <typename Refine>
void unlessWorse(std::vector<Candidate>& candidates, double worse, const Refine& refine) {
  const std::vector<Candidate> before = candidates;
  refine();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].rank < before[i].rank - worse) candidates[i] = before[i];
  }
}

}  // namespace

void refineFinely(std::vector<Candidate>& candidates,
                  const ReferenceDatabase& database,
                  const RefineScene& scene,
                  const FineEffort& effort) {
  if (candidates.empty()) return;
  candidates.erase(
      std::remove_if(candidates.begin() + 1,
                     candidates.end(),
                     [&](const Candidate& one) { return one.rank < scene.align.glanced; }),
      candidates.end());
  refineAll(candidates,
            database,
            scene,
            {effort.rounds,
             effort.points,
             scene.align.first_reach,
             scene.align.rest.last_reach,
             scene.align.rest.rim_reach},
            effort.still);
  std::erase_if(candidates, [&](const Candidate& one) { return one.rank < scene.align.hopeless; });
  candidates = bestDistinct(std::move(candidates), database, effort.finalists);
  unlessWorse(candidates, scene.align.worse, [&] {
    refineAll(candidates, database, scene, scene.align.rest, effort.still);
  });
}

void refineTies(std::vector<Candidate>& candidates,
                const ReferenceDatabase& database,
                const RefineScene& scene) {
  unlessWorse(candidates, scene.align.worse, [&] {
    refineAll(candidates, database, scene, scene.align.tie, scene.align.tie_still);
  });
}

namespace {

/// Aligns every pixel that shows a candidate with what was measured there.
void alignPixels(std::vector<Candidate>& candidates,
                 const ReferenceDatabase& database,
                 const RefineScene& scene) {
  std::vector<RenderTask> tasks;
  for (const Candidate& candidate : candidates) {
    const ReferenceObject& object = objectOf(candidate, database);
    const double tolerance_mm = toleranceFor(object, scene.noise_mm);
    RenderTask& task = tasks.emplace_back(surfaceTask(
        object, candidate.pose, scene.depth.camera, scene.noise_mm, scene.align.settle_px));
    task.max_points = scene.align.settle_px * scene.align.settle_px;
    task.alignment = icpOptions(tolerance_mm, tolerance_mm, scene.align.settle_iterations);
    task.alignment.search_steps = 0;
    task.alignment.slide = 0.0;
  }
  const std::vector<IcpResult> aligned = scene.stages.refine->alignSurfaces(scene.resident, tasks);
  for (std::size_t i = 0; i < aligned.size(); ++i)
    candidates[i].pose = aligned[i].camera_from_object;
}

}  // namespace

void settle(std::vector<Candidate>& candidates,
            const ReferenceDatabase& database,
            const RefineScene& scene) {
  unlessWorse(candidates, scene.align.worse, [&] {
    for (int round = 0; round < scene.align.settle_rounds; ++round)
      alignPixels(candidates, database, scene);
    checkAll(candidates, database, scene);
  });
}

void checkFreeTurns(std::vector<Candidate>& candidates,
                    const ReferenceDatabase& database,
                    const RefineScene& scene) {
  checkAll(candidates, database, scene);
  std::erase_if(candidates, [&](const Candidate& one) { return one.rank < scene.align.hopeless; });
  refineTies(candidates, database, scene);
}

void checkTwins(std::vector<Candidate>& candidates,
                const ReferenceDatabase& database,
                const RefineScene& scene) {
  checkAll(candidates, database, scene);
  std::erase_if(candidates, [&](const Candidate& one) { return one.rank < scene.align.hopeless; });
  const std::vector<Candidate> before = candidates;
  settle(candidates, database, scene);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const PoseDistance distance(objectOf(candidates[i], database));
    if (!distance.below(scene.align.held, before[i].pose, candidates[i].pose))
      candidates[i] = before[i];
  }
}

}  // namespace rangepose
