// What users see of a system on a set of images: the figures of the gate (docs/gate.md).
//
// Images are counted once each (ImageTally), so that figures of any draw of images are cheap: the
// uncertainty of a figure comes from such draws.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "eval/judged_poses.h"
#include "eval/matching.h"
#include "eval/picking_scores.h"
#include "io/bop.h"

namespace rangepose {

using ImageId = std::pair<int, int>;  ///< scene, image

/// The graded poses of a system on the images of a data set.
struct GradedRun {
  std::vector<ImageId> images;        ///< all, with and without poses
  std::vector<ObjectErrors> shown;    ///< poses that users see: at the usual score limit
  std::vector<ObjectErrors> checked;  ///< of a second run: at a low score limit
  std::map<ImageId, double> times_s;  ///< of the images with a measured time
};

/// What one image tells of one system.
struct ImageTally {
  ImageId id;
  bool holds_none = false;          ///< no part of the database lies in it, hidden ones included
  int parts = 0;                    ///< that must be found
  std::optional<bool> first_right;  ///< the pose with the top score; empty without such a part
  std::vector<JudgedPose> shown;
  int found_as_seen = 0;
  int false_as_seen = 0;
  std::vector<JudgedPose> checked;
  double time_s = 0.0;  ///< NaN where not measured
};

/// NaN where there is nothing to count. Scores of `checked` poses are taken as probabilities.
struct GateFigures {
  int images = 0;
  int parts = 0;            ///< that must be found
  double first_pick = 0.0;  ///< share of the images with a part that must be found
  double recall = 0.0;
  double recall_as_seen = 0.0;
  double precision = 0.0;
  double precision_as_seen = 0.0;
  double average_precision = 0.0;  ///< of the checked poses
  double recall_checked = 0.0;     ///< of the checked poses
  int sure = 0;                    ///< shown poses with a score above kSure
  double sure_right = 0.0;         ///< share of them
  int none_images = 0;             ///< that hold no part of the database
  double none_poses = 0.0;         ///< shown poses in such an image, all of them wrong
  int checked = 0;                 ///< checked poses
  double brier = 0.0;              ///< mean of (score - 1 if right, else 0)^2
  double calibration_error = 0.0;  ///< mean over poses of |mean score - share right| of its tenth
  double mean_right = 0.0;         ///< mean score of right checked poses
  double mean_wrong = 0.0;         ///< likewise of wrong ones
  double median_mssd = 0.0;        ///< of right shown poses [diameters]
  double time_s = 0.0;             ///< median over the images
  std::vector<ReliabilityBin> reliability;  ///< of the checked poses
};

inline constexpr double kSure = 0.9;

/// Times of the images that have a row with one.
std::map<ImageId, double> timesOf(const std::vector<BopEstimate>& rows);

/// The rows as poses that are all wrong: of images that hold no part of the database.
std::vector<ObjectErrors> wrongPoses(const std::vector<BopEstimate>& rows);

/// In the order of run.images. `objects` are those in the database: true poses of others are
/// nothing that could be found. Of a part of them the tallies are those of these parts alone.
std::vector<ImageTally> tallyImages(const GradedRun& run,
                                    const std::set<int>& objects,
                                    const PickingOptions& options = {});

/// The same tally may come several times.
GateFigures gateFigures(const std::vector<const ImageTally*>& tallies);
GateFigures gateFigures(const std::vector<ImageTally>& tallies);

}  // namespace rangepose
