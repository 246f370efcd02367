// What counts in a robot cell: is the first pick right, how many parts are found, how many of the
// answers are wrong, and does the score say so.
//
// A pose is right when its MSSD is below a share of the diameter. Estimates are matched greedily by
// score, each with one true pose. A right pose of a part that is less visible than `min_visible` is
// neither found nor false: it is left out of recall, precision and average precision (as PASCAL VOC
// treats objects marked as difficult). A second right pose of the same part is false.
//
// What an image does not show decides nothing: of a part that looks the same either way up, one
// that lies so that the difference is hidden, no method knows how it lies. "As seen" a pose is also
// right when it looks like the true one.
#pragma once

#include <optional>
#include <vector>

#include "eval/matching.h"

namespace rangepose {

struct PickingOptions {
  double right = 0.10;        ///< MSSD of a right pose is below this [diameters], at most 0.1
  double strict = 0.02;       ///< the same where precision matters [diameters]
  double unlike = 0.005;      ///< poses look the same when `unlike` of ObjectErrors is below this
  double min_visible = 0.50;  ///< parts less visible need not be found
  void check() const;         ///< throws Error naming the bad field
};

/// When only estimates with at least this score are kept.
struct PrecisionRecall {
  double score = 0.0;
  double precision = 0.0;
  double recall = 0.0;
};

/// Estimates with scores in [low, high); the last bin includes 1.
struct ReliabilityBin {
  double low = 0.0;
  double high = 0.0;
  int count = 0;
  double mean_score = 0.0;
  double right = 0.0;  ///< share that is right, barely visible parts included
};

/// Shares are 0..1, and NaN where there is nothing to count.
struct PickingScores {
  int images = 0;                  ///< with at least one part that must be found
  double first_pick = 0.0;         ///< of those images: the estimate with the top score is right
  double first_pick_strict = 0.0;  ///< likewise, by the strict limit
  int parts = 0;                   ///< that must be found
  double recall = 0.0;
  double recall_strict = 0.0;
  int estimates = 0;
  int ignored = 0;  ///< right poses of barely visible parts
  double precision = 0.0;
  double average_precision = 0.0;  ///< all-point interpolation
  double recall_at_99 = 0.0;       ///< largest recall of a score limit with precision >= 0.99
  double recall_as_seen = 0.0;
  double precision_as_seen = 0.0;
  double median_mssd = 0.0;  ///< of right poses [diameters]
  double median_rotation_rad = 0.0;
  double median_translation_mm = 0.0;
  std::vector<PrecisionRecall> curve;       ///< by falling score, one point for each score
  std::vector<ReliabilityBin> reliability;  ///< ten bins; empty when a score lies outside of 0..1
};

/// Of one object, or of all.
PickingScores pickingScores(const std::vector<ObjectErrors>& images,
                            const PickingOptions& options,
                            const std::optional<int>& obj_id = std::nullopt);

/// Recall of the parts that must be found when `limit` [diameters] is what makes a pose right.
double recallAt(const std::vector<ObjectErrors>& images,
                double limit,
                double min_visible,
                const std::optional<int>& obj_id = std::nullopt);

}  // namespace rangepose
