#include "compare/refine_stages.h"

#include <cmath>

#include "pipeline/candidates.h"
#include "pipeline/pose_distance.h"

namespace rangepose {
namespace {

constexpr int kPoints = 220;
constexpr double kRimReach = 0.08;  // of the diameter

class RefineComparison {
 public:
  RefineComparison(const DepthImage& depth,
                   const ReferenceDatabase& database,
                   const Estimate& estimate,
                   const EstimateTrace& trace,
                   StageSet& reference,
                   StageSet& subject)
      : depth_(depth),
        database_(database),
        candidates_(trace.coarse),
        noise_mm_(estimate.noise_mm),
        reference_(reference),
        subject_(subject),
        at_reference_(reference.foreground->upload(depth, trace.foreground)),
        at_subject_(subject.foreground->upload(depth, trace.foreground)) {
    for (const PoseEstimate& candidate : candidates_) addTasks(candidate);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      alignments_[i].points = &points_[i];
      verdicts_[i].points = &points_[i];
    }
  }

  void compare() {
    const auto at = [&](StageSet& stages) -> const ResidentDepth& {
      return &stages == &reference_ ? *at_reference_ : *at_subject_;
    };
    poses(alignment_.run(
              reference_,
              subject_,
              [&](StageSet& stages) { return stages.refine->align(at(stages), alignments_); }),
          alignment_);
    scores(
        verdict_.run(reference_,
                     subject_,
                     [&](StageSet& stages) { return stages.refine->judge(at(stages), verdicts_); }),
        verdict_);
    poses(surface_alignment_.run(reference_,
                                 subject_,
                                 [&](StageSet& stages) {
                                   return stages.refine->alignSurfaces(at(stages), surfaces_);
                                 }),
          surface_alignment_);
    scores(surface_verdict_.run(reference_,
                                subject_,
                                [&](StageSet& stages) {
                                  return stages.refine->judgeSurfaces(at(stages), surfaces_);
                                }),
           surface_verdict_);
  }

  std::vector<StageComparison> results() const {
    return {alignment_.result(),
            verdict_.result(),
            surface_alignment_.result(),
            surface_verdict_.result()};
  }

 private:
  const ReferenceObject& objectOf(const PoseEstimate& candidate) const {
    return database_.objects[static_cast<std::size_t>(candidate.object)];
  }

  void addTasks(const PoseEstimate& candidate) {
    const ReferenceObject& object = objectOf(candidate);
    const double tolerance = toleranceFor(object, noise_mm_);
    IcpOptions icp;
    icp.first_reach_mm = 6.0 * tolerance;
    icp.last_reach_mm = tolerance;
    icp.rim_reach_mm = kRimReach * object.diameter_mm;
    points_.push_back(pointsAndRimOfView(object, candidate.view, kPoints));
    alignments_.push_back({nullptr, candidate.pose, object.center_mm, object.radius_mm, icp});
    verdicts_.push_back({nullptr,
                         candidate.pose,
                         visibleArea(object, candidate.view),
                         checkOptionsFor(object, noise_mm_)});
    RenderTask& task =
        surfaces_.emplace_back(surfaceTask(object, candidate.pose, depth_.camera, noise_mm_));
    task.max_points = 4 * kPoints;
    task.alignment = icp;
  }

  using Poses = std::vector<IcpResult>;
  void poses(const std::pair<Poses, Poses>& both, Tally& tally) const {
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const ReferenceObject& object = objectOf(candidates_[i]);
      const PoseDistance distance(object);
      tally.add(object.diameter_mm *
                distance(both.first[i].camera_from_object, both.second[i].camera_from_object));
    }
  }
  using Scores = std::vector<CheckResult>;
  void scores(const std::pair<Scores, Scores>& both, Tally& tally) const {
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      tally.add(std::abs(both.first[i].score - both.second[i].score));
  }

  const DepthImage& depth_;
  const ReferenceDatabase& database_;
  const std::vector<PoseEstimate>& candidates_;
  double noise_mm_;
  StageSet& reference_;
  StageSet& subject_;
  std::unique_ptr<ResidentDepth> at_reference_;
  std::unique_ptr<ResidentDepth> at_subject_;
  std::vector<std::vector<SurfacePoint>> points_;
  std::vector<AlignTask> alignments_;
  std::vector<JudgeTask> verdicts_;
  std::vector<RenderTask> surfaces_;
  Tally alignment_{"alignment", subject_.name};
  Tally verdict_{"verdict", subject_.name};
  Tally surface_alignment_{"surface alignment", subject_.name};
  Tally surface_verdict_{"surface verdict", subject_.name};
};

}  // namespace

std::vector<StageComparison> compareRefinement(const DepthImage& depth,
                                               const ReferenceDatabase& database,
                                               const Estimate& estimate,
                                               const EstimateTrace& trace,
                                               StageSet& reference,
                                               StageSet& subject) {
  if (trace.coarse.empty()) return {};
  RefineComparison comparison(depth, database, estimate, trace, reference, subject);
  comparison.compare();
  return comparison.results();
}

}  // namespace rangepose
