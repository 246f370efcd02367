// Poses with their verdicts, and the figures that follow from these alone.
#pragma once

#include <vector>

#include "eval/matching.h"
#include "eval/picking_scores.h"

namespace rangepose {

enum class PoseVerdict {
  kFound,    ///< right, of a part that must be found
  kIgnored,  ///< right, of a part that is barely visible: neither found nor false
  kFalse,    ///< wrong, or a second pose of the same part
};

struct JudgedPose {
  double score = 0.0;
  PoseVerdict verdict = PoseVerdict::kFalse;
  double error = 0.0;  ///< against the true pose that it is matched with; NaN where false
};

/// The estimates of one object in one image, by falling score. A pose is right when its error is
/// below `limit`; parts less visible than `min_visible` need not be found.
std::vector<JudgedPose> judgePoses(const ObjectErrors& image,
                                   const PairErrors& errors,
                                   double limit,
                                   double min_visible);

/// MSSD, but just right where poses look the same [diameters].
PairErrors errorsAsSeen(const ObjectErrors& image, const PickingOptions& options);

/// True poses that must be found.
int partsToFind(const ObjectErrors& image, double min_visible);

int countOf(const std::vector<JudgedPose>& judged, PoseVerdict verdict);

/// By falling score; of equal scores the order stays.
void sortByScore(std::vector<JudgedPose>& judged);

/// `judged` by falling score. Points only after the last estimate of a score: their order is
/// chance.
std::vector<PrecisionRecall> curveOf(const std::vector<JudgedPose>& judged, int parts);

/// Area under the curve, where a precision counts from the largest recall that reaches it
/// downwards.
double averagePrecision(const std::vector<PrecisionRecall>& curve);

/// Ten bins; empty when a score lies outside of 0..1.
std::vector<ReliabilityBin> reliabilityOf(const std::vector<JudgedPose>& judged);

/// NaN of nothing.
double shareOf(int count, int all);
double medianOf(std::vector<double> values);

}  // namespace rangepose
