// Scenes with a known answer, and what an estimate made of them.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

#include "database/reference_database.h"
#include "pipeline/estimate.h"
#include "pipeline/pose_distance.h"
#include "sim/scanner.h"

namespace rangepose::test {

/// A pose counts as right when its points lie this near to those of a true one, symmetries aside
/// [share of the diameter].
inline constexpr double kRightPose = 0.05;

/// What a cell that must not err takes for `--min-score`, as the README says.
inline constexpr double kSure = 0.9;

struct Judged {
  int right = 0;             ///< poses of parts that are there, each part counted once
  int wrong = 0;             ///< all other poses
  int missed = 0;            ///< parts of the database visible by at least half that have no pose
  double best_wrong = 0.0;   ///< highest score of a wrong pose
  double least_right = 1.0;  ///< lowest score of a right one
  double error = 0.0;        ///< largest distance of a right one, as kRightPose
};

inline std::ostream& operator<<(std::ostream& out, const Judged& judged) {
  return out << judged.right << " right (score >= " << judged.least_right
             << ", error <= " << 100.0 * judged.error << " %), " << judged.wrong
             << " wrong (score <= " << judged.best_wrong << "), " << judged.missed << " missed";
}

/// The parts of `scan` whose mesh is `objects[mesh]` of the database; -1: not in it.
inline Judged judge(const Estimate& estimate,
                    const Scan& scan,
                    const ReferenceDatabase& database,
                    const std::vector<int>& objects) {
  Judged judged;
  std::vector<bool> found(scan.truth.size(), false);
  for (const PoseEstimate& pose : estimate.poses) {
    const PoseDistance distance(database.objects[static_cast<std::size_t>(pose.object)]);
    bool right = false;
    for (std::size_t i = 0; i < scan.truth.size() && !right; ++i) {
      if (found[i] || objects[static_cast<std::size_t>(scan.truth[i].mesh)] != pose.object)
        continue;
      const double error = distance(pose.pose, scan.truth[i].camera_from_object);
      if (!(error < kRightPose)) continue;
      right = true;
      found[i] = true;
      judged.error = std::max(judged.error, error);
    }
    ++(right ? judged.right : judged.wrong);
    if (right) judged.least_right = std::min(judged.least_right, pose.confidence);
    if (!right) judged.best_wrong = std::max(judged.best_wrong, pose.confidence);
  }
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    const bool searched = objects[static_cast<std::size_t>(scan.truth[i].mesh)] >= 0;
    judged.missed += searched && !found[i] && scan.truth[i].visible_fraction >= 0.5 ? 1 : 0;
  }
  return judged;
}

inline Estimate estimateAll(const DepthImage& image,
                            const ReferenceDatabase& database,
                            const std::optional<BinBox>& bin = std::nullopt) {
  const std::unique_ptr<StageSet> stages = makeHostStages();
  EstimateOptions options;
  options.max_poses = 100;
  return estimatePoses(image, bin, database, options, *stages);
}

}  // namespace rangepose::test
