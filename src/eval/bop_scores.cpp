#include "eval/bop_scores.h"

#include <limits>

namespace rangepose {
namespace {

constexpr int kThresholds = 10;
constexpr double kMssdStep = 0.05;
constexpr double kMspdStepPx = 5.0;
constexpr double kVsdStep = 0.05;

/// Targets of an image that are found, summed over the thresholds step, 2 step, ...
int foundOverThresholds(const ObjectErrors& image, const PairErrors& errors, double step) {
  const std::vector<bool> eligible = largest(image.visible_fractions, image.targets);
  if (image.targets == 0 || errors.empty()) return 0;
  int found = 0;
  for (int i = 1; i <= kThresholds; ++i) {
    for (const int match : matchGreedily(errors, step * i, eligible, image.targets)) {
      found += match != kUnmatched ? 1 : 0;
    }
  }
  return found;
}

}  // namespace

BopScores bopScores(const std::vector<ObjectErrors>& images, const std::optional<int>& obj_id) {
  BopScores scores;
  long long vsd = 0;
  long long mssd = 0;
  long long mspd = 0;
  std::size_t taus = 1;
  for (const ObjectErrors& image : images) {
    if (obj_id && image.obj_id != *obj_id) continue;
    scores.targets += image.targets;
    mssd += foundOverThresholds(image, image.mssd, kMssdStep);
    mspd += foundOverThresholds(image, image.mspd_px, kMspdStepPx);
    taus = image.vsd.size();
    for (const PairErrors& errors : image.vsd) vsd += foundOverThresholds(image, errors, kVsdStep);
  }
  const double all = static_cast<double>(scores.targets) * kThresholds;
  if (scores.targets == 0) {
    scores.vsd = scores.mssd = scores.mspd = std::numeric_limits<double>::quiet_NaN();
    return scores;
  }
  scores.vsd = static_cast<double>(vsd) / (all * static_cast<double>(taus));
  scores.mssd = static_cast<double>(mssd) / all;
  scores.mspd = static_cast<double>(mspd) / all;
  return scores;
}

}  // namespace rangepose
