#include "pipeline/refine.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "pipeline/scene_window.h"

namespace rangepose {
namespace {

constexpr int kFinePoints = 900;
constexpr int kRenderPx = 112;
constexpr int kFineIterations = 12;
constexpr double kLaterReach = 1.5;  // tolerances
/// A pose that moves by less has come to rest [share of the diameter].
constexpr double kStill = 1e-4;

/// Mean distance of the object's extreme points in two poses, as a share of its diameter.
double distanceBetween(const ReferenceObject& object, const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (int corner = 0; corner < 6; ++corner) {
    glm::dvec3 point = object.center_mm;
    point[corner / 2] += (corner % 2 == 0 ? 0.6 : -0.6) * object.radius_mm;
    sum += glm::distance(a * point, b * point);
  }
  return sum / 6.0 / object.diameter_mm;
}

CheckOptions checkOptionsFor(const ReferenceObject& object, double noise_mm) {
  CheckOptions options;
  options.tolerance_mm = toleranceFor(object, noise_mm);
  return options;
}

IcpOptions icpOptions(double first_reach_mm, double last_reach_mm, int iterations) {
  IcpOptions options;
  options.iterations = iterations;
  options.last_reach_mm = last_reach_mm;
  options.first_reach_mm = std::max(first_reach_mm, last_reach_mm);
  return options;
}

/// Of two poses that fit equally well the one that explains more of the scene is the better
/// explanation: a part's face alone can be laid on many surfaces.
double rankOf(const CheckResult& check, double mean_visible_mm2) {
  return check.score * std::sqrt(check.explained_mm2 / mean_visible_mm2);
}

/// Mean area of the object's views [mm^2].
double meanVisibleArea(const ReferenceObject& object) {
  return object.meanArea() * object.pixel_mm * object.pixel_mm;
}

struct FineRounds {
  int rounds;          ///< at most
  double first_reach;  ///< of the first round [tolerances]
};

/// Renders, aligns what is visible, and again until the pose is at rest; then checks.
void refineOne(Candidate& candidate,
               const ReferenceObject& object,
               const RefineScene& scene,
               const FineRounds& fine,
               StageSet& stages) {
  const Camera& camera = scene.depth.camera;
  const double tolerance = toleranceFor(object, scene.noise_mm);
  const auto render = [&](SurfaceWindow& window) {
    window =
        wholeWindowAround(camera, candidate.pose * object.center_mm, object.radius_mm, kRenderPx);
    return stages.renderSurface(object.mesh, camera, candidate.pose, window);
  };
  SurfaceWindow window;
  for (int round = 0; round < fine.rounds; ++round) {
    const Image<SurfaceTexel> surface = render(window);
    const std::vector<SurfacePoint> points =
        pointsOfSurface(surface, camera, window, candidate.pose, kFinePoints);
    const double reach = round == 0 ? fine.first_reach : kLaterReach;
    const IcpOptions options = icpOptions(reach * tolerance, tolerance, kFineIterations);
    const Pose before = candidate.pose;
    candidate.pose = host::icp(points,
                               camera,
                               scene.foreground_mm,
                               candidate.pose,
                               object.center_mm,
                               object.radius_mm,
                               options)
                         .camera_from_object;
    if (distanceBetween(object, before, candidate.pose) < kStill) break;
  }
  const Image<SurfaceTexel> surface = render(window);
  candidate.check =
      host::check(surface, window, scene.depth, checkOptionsFor(object, scene.noise_mm));
  candidate.rank = rankOf(candidate.check, meanVisibleArea(object));
}

}  // namespace

double toleranceFor(const ReferenceObject& object, double noise_mm) {
  return std::max(0.02 * object.diameter_mm, 3.0 * noise_mm);
}

namespace {

using ViewPoints = std::vector<std::vector<SurfacePoint>>;  ///< by view

ViewPoints fewPointsOfViews(const ReferenceObject& object) {
  constexpr int kPoints = 40;
  constexpr int kViewsPerPiece = 64;
  ViewPoints points(object.views.size());
  parallelFor(static_cast<int>(points.size()), kViewsPerPiece, [&](int begin, int end) {
    for (int view = begin; view < end; ++view)
      points[static_cast<std::size_t>(view)] = pointsOfView(object, view, kPoints);
  });
  return points;
}

/// Judges rough poses by a few points of their views against the depth image, with a tolerance as
/// wide as a rough pose is wrong. Unlike Eq. 1 it sees the difference between surface that is
/// hidden and surface that is not there, which decides on parts that are partly covered.
void judgeRoughly(std::vector<Candidate>& candidates,
                  const ReferenceObject& object,
                  const ViewPoints& points,
                  const RefineScene& scene) {
  constexpr int kCandidatesPerPiece = 64;
  CheckOptions options;
  options.tolerance_mm = std::max(0.05 * object.diameter_mm, 3.0 * scene.noise_mm);
  options.max_tilt_rad = 1.2;
  const double pixel_mm2 = object.pixel_mm * object.pixel_mm;
  const double mean_mm2 = meanVisibleArea(object);
  parallelFor(static_cast<int>(candidates.size()), kCandidatesPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Candidate& candidate = candidates[static_cast<std::size_t>(i)];
      const auto view = static_cast<std::size_t>(candidate.view);
      const double visible_mm2 = static_cast<double>(object.views[view].area_px) * pixel_mm2;
      candidate.check =
          host::checkPoints(points[view], candidate.pose, visible_mm2, scene.depth, options);
      candidate.rank = rankOf(candidate.check, mean_mm2);
    }
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

/// Takes from the two orders in turn what is not yet there, `count` in all.
std::vector<Candidate> takeInTurn(const Order& first,
                                  const Order& second,
                                  const ReferenceObject& object,
                                  int count) {
  constexpr double kSame = 0.04;
  std::vector<Candidate> kept;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (const Candidate* candidate : {first[i], second[i]}) {
      if (static_cast<int>(kept.size()) >= count) return kept;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) {
        return distanceBetween(object, other.rough, candidate->rough) < kSame;
      });
      if (!known) kept.push_back(*candidate);
    }
  }
  return kept;
}

}  // namespace

std::vector<Candidate> bestCandidates(const ReferenceObject& object,
                                      int object_index,
                                      const std::vector<Hypothesis>& hypotheses,
                                      const std::vector<OrthoCamera>& cameras,
                                      const RefineScene& scene,
                                      int count) {
  const ViewPoints points = fewPointsOfViews(object);
  std::vector<Candidate> best;
  for (int w = 0; w < static_cast<int>(cameras.size()); ++w) {
    std::vector<Candidate> own;
    for (const Hypothesis& hypothesis : hypotheses) {
      if (hypothesis.window != w || hypothesis.error >= kWorstError) continue;
      const Pose pose = poseOf(hypothesis, object, cameras[static_cast<std::size_t>(w)]);
      own.push_back({object_index, hypothesis.view, w, hypothesis.error, pose, pose, {}, 0.0});
    }
    judgeRoughly(own, object, points, scene);
    const Order by_error = ordered(
        own, [](const Candidate& a, const Candidate& b) { return a.rough_error < b.rough_error; });
    const Order by_rank =
        ordered(own, [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
    const std::vector<Candidate> kept = takeInTurn(by_error, by_rank, object, count);
    best.insert(best.end(), kept.begin(), kept.end());
  }
  return best;
}

namespace {

/// One round of alignment with the points of the candidates' own views.
struct CoarseRound {
  int points;
  int iterations;
  int search_steps;
  double first_reach;      ///< share of the diameter
  double last_tolerances;  ///< reach of the last iteration, in tolerances
};

void alignWithViews(std::vector<Candidate>& candidates,
                    const ReferenceDatabase& database,
                    const RefineScene& scene,
                    const CoarseRound& round) {
  constexpr int kCandidatesPerPiece = 4;
  std::vector<double> mean_mm2;
  for (const ReferenceObject& object : database.objects)
    mean_mm2.push_back(meanVisibleArea(object));
  parallelFor(static_cast<int>(candidates.size()), kCandidatesPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Candidate& candidate = candidates[static_cast<std::size_t>(i)];
      const ReferenceObject& object = database.objects[static_cast<std::size_t>(candidate.object)];
      const ReferenceView& view = object.views[static_cast<std::size_t>(candidate.view)];
      const double tolerance = toleranceFor(object, scene.noise_mm);
      const std::vector<SurfacePoint> points = pointsOfView(object, candidate.view, round.points);
      IcpOptions options = icpOptions(round.first_reach * object.diameter_mm,
                                      round.last_tolerances * tolerance,
                                      round.iterations);
      options.search_steps = round.search_steps;
      candidate.pose = host::icp(points,
                                 scene.depth.camera,
                                 scene.foreground_mm,
                                 candidate.pose,
                                 object.center_mm,
                                 object.radius_mm,
                                 options)
                           .camera_from_object;
      const double visible_mm2 =
          static_cast<double>(view.area_px) * object.pixel_mm * object.pixel_mm;
      candidate.check = host::checkPoints(points,
                                          candidate.pose,
                                          visible_mm2,
                                          scene.depth,
                                          checkOptionsFor(object, scene.noise_mm));
      candidate.rank =
          rankOf(candidate.check, mean_mm2[static_cast<std::size_t>(candidate.object)]);
    }
  });
}

}  // namespace

std::vector<Candidate> refineCoarsely(std::vector<Candidate> candidates,
                                      const ReferenceDatabase& database,
                                      const RefineScene& scene,
                                      int count) {
  // A few steps with few points tell which of many hypotheses are worth more.
  constexpr CoarseRound kMany{60, 8, 1, 0.20, 2.0};
  constexpr CoarseRound kFew{220, 8, 2, 0.06, 1.5};
  constexpr int kFewPerKept = 4;
  alignWithViews(candidates, database, scene, kMany);
  candidates = bestDistinct(std::move(candidates), database, kFewPerKept * count);
  alignWithViews(candidates, database, scene, kFew);
  return bestDistinct(std::move(candidates), database, count);
}

std::vector<Candidate> bestDistinct(std::vector<Candidate> candidates,
                                    const ReferenceDatabase& database,
                                    int count) {
  constexpr double kSame = 0.03;
  std::stable_sort(candidates.begin(),
                   candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
  std::vector<Candidate> best;
  std::map<std::pair<int, int>, int> taken;
  for (const Candidate& candidate : candidates) {
    int& taken_here = taken[{candidate.object, candidate.window}];
    if (taken_here >= count) continue;
    const ReferenceObject& object = database.objects[static_cast<std::size_t>(candidate.object)];
    const bool known = std::any_of(best.begin(), best.end(), [&](const Candidate& other) {
      return other.object == candidate.object &&
             distanceBetween(object, other.pose, candidate.pose) < kSame;
    });
    if (known) continue;
    best.push_back(candidate);
    ++taken_here;
  }
  return best;
}

std::vector<Candidate> bestOfEachPlace(std::vector<Candidate> candidates,
                                       const ReferenceDatabase& database) {
  constexpr double kSamePlace = 0.5;  // of the larger diameter
  std::stable_sort(candidates.begin(),
                   candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
  std::vector<Candidate> best;
  for (const Candidate& candidate : candidates) {
    const ReferenceObject& object = database.objects[static_cast<std::size_t>(candidate.object)];
    const glm::dvec3 center = candidate.pose * object.center_mm;
    const bool taken = std::any_of(best.begin(), best.end(), [&](const Candidate& other) {
      const ReferenceObject& owner = database.objects[static_cast<std::size_t>(other.object)];
      const double reach = kSamePlace * std::max(object.diameter_mm, owner.diameter_mm);
      return glm::distance(center, other.pose * owner.center_mm) < reach;
    });
    if (!taken) best.push_back(candidate);
  }
  std::stable_sort(best.begin(), best.end(), [](const Candidate& a, const Candidate& b) {
    return a.check.score > b.check.score;
  });
  return best;
}

void refineFinely(std::vector<Candidate>& candidates,
                  const ReferenceDatabase& database,
                  const RefineScene& scene,
                  StageSet& stages) {
  // A short alignment of all tells which few are worth a long one.
  constexpr FineRounds kAll{2, 6.0};
  constexpr FineRounds kFinalists{8, 3.0};
  constexpr int kFinalistsPerStart = 3;
  const auto refineAll = [&](std::vector<Candidate>& all, const FineRounds& fine) {
    const int count = static_cast<int>(all.size());
    const int grain = stages.concurrent() ? 1 : std::max(count, 1);
    parallelFor(count, grain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        Candidate& candidate = all[static_cast<std::size_t>(i)];
        const ReferenceObject& object =
            database.objects[static_cast<std::size_t>(candidate.object)];
        refineOne(candidate, object, scene, fine, stages);
      }
    });
  };
  refineAll(candidates, kAll);
  candidates = bestDistinct(std::move(candidates), database, kFinalistsPerStart);
  refineAll(candidates, kFinalists);
}

}  // namespace rangepose
