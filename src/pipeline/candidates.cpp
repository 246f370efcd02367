#include "pipeline/candidates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "pipeline/evidence.h"
#include "pipeline/pose_distance.h"
#include "pipeline/scene_window.h"

namespace rangepose {
namespace {

using Windows = std::vector<std::vector<Candidate>>;  ///< candidates of each window

/// Judges rough poses by a few points of their views against the depth image. Unlike Eq. 1 it sees
/// the difference between surface that is hidden and surface that is not there, which decides on
/// parts that are partly covered.
void judgeRoughly(Windows& windows, const ReferenceObject& object, const RefineScene& scene) {
  const CheckOptions options = glanceOptionsFor(object, scene.noise_mm);
  std::vector<int> views;
  std::vector<std::size_t> first;  // of the tasks of each window
  for (const std::vector<Candidate>& own : windows) {
    first.push_back(views.size());
    for (const Candidate& candidate : own) views.push_back(candidate.view);
  }
  const auto points = scene.stages.points_of_views.of(object, kFewPoints, views);
  std::vector<JudgeTask> tasks(views.size());
  parallelForEach(windows.size(), 1, [&](std::size_t w) {
    std::size_t next = first[w];
    for (const Candidate& candidate : windows[w]) {
      tasks[next++] = {&points->of[static_cast<std::size_t>(candidate.view)],
                       candidate.pose,
                       visibleArea(object, candidate.view),
                       options,
                       points->nameOf(candidate.view)};
    }
  });
  const std::vector<CheckResult> verdicts = scene.stages.refine->judge(scene.resident, tasks);
  const double mean_mm2 = meanVisibleArea(object);
  parallelForEach(windows.size(), 1, [&](std::size_t w) {
    std::size_t next = first[w];
    for (Candidate& candidate : windows[w]) setVerdict(candidate, verdicts[next++], mean_mm2);
  });
}

using Order = std::vector<const Candidate*>;

template <typename Before>
Order ordered(const std::vector<Candidate>& candidates, const Before& before) {
  Order order;
  for (const Candidate& candidate : candidates) order.push_back(&candidate);
  std::stable_sort(order.begin(), order.end(), [&](const Candidate* a, const Candidate* b) {
    return before(*a, *b);
  });
  return order;
}

/// Takes from the two orders in turn what is not yet there and lies where a part can be, `count` in
/// all.
std::vector<Candidate> takeInTurn(const Order& first,
                                  const Order& second,
                                  const ReferenceObject& object,
                                  const Enclosure& enclosure,
                                  int count) {
  constexpr double kSame = 0.04;
  const double off_mm = 0.05 * object.diameter_mm;  // of a rough pose, into the floor
  PoseList known(object);
  std::vector<Candidate> kept;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (const Candidate* candidate : {first[i], second[i]}) {
      if (static_cast<int>(kept.size()) >= count) return kept;
      if (known.holds(kSame, candidate->rough) ||
          !enclosure.holds(candidate->object, candidate->rough, off_mm))
        continue;
      known.add(candidate->rough);
      kept.push_back(*candidate);
    }
  }
  return kept;
}

}  // namespace

double visibleArea(const ReferenceObject& object, int view) {
  const float area_px = object.views[static_cast<std::size_t>(view)].area_px;
  return static_cast<double>(area_px) * object.pixel_mm * object.pixel_mm;
}

double meanVisibleArea(const ReferenceObject& object) {
  return object.meanArea() * object.pixel_mm * object.pixel_mm;
}

void setVerdict(Candidate& candidate, const CheckResult& check, double mean_visible_mm2) {
  candidate.check = check;
  candidate.rank = check.score * std::sqrt(check.explained_mm2 / mean_visible_mm2);
}

namespace {

void setOdds(Candidate& candidate) {
  candidate.rank = logOddsOf(candidate.evidence, candidate.check.inner_px);
  candidate.confidence = probabilityOf(candidate.rank);
}

}  // namespace

void setTerm(Candidate& candidate, EvidenceTerm term, double value) {
  candidate.evidence[static_cast<std::size_t>(term)] = value;
  setOdds(candidate);
}

void setEvidence(Candidate& candidate, const CheckResult& check, double mean_visible_mm2) {
  candidate.check = check;
  candidate.evidence = evidenceTerms(check, {mean_visible_mm2, candidate.outside});
  setOdds(candidate);
}

CheckOptions checkOptionsFor(const ReferenceObject& object, double noise_mm) {
  CheckOptions options;
  options.tolerance_mm = toleranceFor(object, noise_mm);
  options.error_mm = noise_mm;
  return options;
}

CheckOptions glanceOptionsFor(const ReferenceObject& object, double noise_mm) {
  CheckOptions options;
  options.tolerance_mm = std::max(0.05 * object.diameter_mm, 3.0 * noise_mm);
  options.max_tilt_rad = 1.2;
  return options;
}

RenderTask surfaceTask(const ReferenceObject& object,
                       const Pose& camera_from_object,
                       const Camera& camera,
                       double noise_mm,
                       int most_px) {
  RenderTask task;
  task.mesh = &object.mesh;
  task.camera_from_object = camera_from_object;
  task.window =
      wholeWindowAround(camera, camera_from_object * object.center_mm, object.radius_mm, most_px);
  task.center_mm = object.center_mm;
  task.radius_mm = object.radius_mm;
  task.check = checkOptionsFor(object, noise_mm);
  return task;
}

double toleranceFor(const ReferenceObject& object, double noise_mm) {
  return std::max(object.finerIfThin(0.02 * object.diameter_mm), 3.0 * noise_mm);
}

std::vector<Candidate> bestCandidates(const ReferenceObject& object,
                                      int object_index,
                                      const std::vector<Hypothesis>& hypotheses,
                                      const std::vector<OrthoCamera>& cameras,
                                      const RefineScene& scene,
                                      int count) {
  const std::size_t views = object.views.size();
  RP_CHECK(hypotheses.size() == views * cameras.size(),
           "one hypothesis a view and window is needed");
  Windows windows(cameras.size());
  parallelForEach(windows.size(), 1, [&](std::size_t w) {
    for (std::size_t i = w * views; i < (w + 1) * views; ++i) {
      const Hypothesis& one = hypotheses[i];
      if (one.error >= kWorstError) continue;
      const Pose pose = poseOf(one, object, cameras[w]);
      windows[w].push_back({object_index, one.view, one.window, one.error, pose, pose, {}, 0.0});
    }
  });
  judgeRoughly(windows, object, scene);
  parallelForEach(windows.size(), 1, [&](std::size_t w) {
    const std::vector<Candidate>& own = windows[w];
    const Order by_error = ordered(
        own, [](const Candidate& a, const Candidate& b) { return a.rough_error < b.rough_error; });
    const Order by_rank =
        ordered(own, [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
    windows[w] = takeInTurn(by_error, by_rank, object, scene.enclosure, count);
  });
  std::vector<Candidate> best;
  for (const std::vector<Candidate>& own : windows) best.insert(best.end(), own.begin(), own.end());
  return best;
}

std::vector<Candidate> bestDistinct(std::vector<Candidate> candidates,
                                    const ReferenceDatabase& database,
                                    int count) {
  constexpr double kSame = 0.03;
  std::stable_sort(candidates.begin(),
                   candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
  std::vector<PoseList> known(database.objects.begin(), database.objects.end());
  std::vector<Candidate> best;
  std::map<std::pair<int, int>, int> taken;
  for (const Candidate& candidate : candidates) {
    int& taken_here = taken[{candidate.object, candidate.window}];
    if (taken_here >= count) continue;
    PoseList& of_object = known[static_cast<std::size_t>(candidate.object)];
    if (of_object.holds(kSame, candidate.pose)) continue;
    of_object.add(candidate.pose);
    best.push_back(candidate);
    ++taken_here;
  }
  return best;
}

}  // namespace rangepose
