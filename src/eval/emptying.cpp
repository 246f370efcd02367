#include "eval/emptying.h"

#include <algorithm>
#include <utility>

namespace rangepose {
namespace {

int mostVisible(const BinScan& scan) {
  const auto best = std::max_element(scan.visible_fractions.begin(), scan.visible_fractions.end());
  return static_cast<int>(best - scan.visible_fractions.begin());
}

}  // namespace

PoseGrade gradePose(const ErrorModel& model, const BinScan& scan, const std::optional<Pose>& pose) {
  PoseGrade grade;
  if (!pose) return grade;
  double nearest_mm = kNoLimit;
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    const double error = vertexErrorMm(model, *pose, scan.truth[i]);
    if (error >= nearest_mm) continue;
    nearest_mm = error;
    grade.part = static_cast<int>(i);
  }
  const Pose& truth = scan.truth[static_cast<std::size_t>(grade.part)];
  grade.vertex = nearest_mm / model.diagonalMm();
  grade.right = grade.vertex < kRightVertexError;
  const glm::dvec3& center = model.sphere().center_mm;
  const Pose copy = nearestCopy(model, *pose, truth);
  grade.center = glm::distance(*pose * center, copy * center) / model.diagonalMm();
  grade.rotation_rad = rotationErrorRad(model, *pose, truth);
  grade.euler_rad = eulerErrorRad(model, *pose, truth);
  return grade;
}

std::vector<Trial> emptyBin(const VirtualBin& bin,
                            const ErrorModel& model,
                            const BinScanOptions& options,
                            const Answerer& answer,
                            const TrialObserver& observe) {
  std::vector<Trial> trials;
  std::vector<bool> left(bin.bin_from_object.size(), true);
  for (std::size_t i = 0; i < left.size(); ++i) {
    BinScanOptions scan_options = options;
    scan_options.seed = options.seed + i;  // noise of its own for each scan
    const BinScan scan = scanVirtualBin(bin, left, scan_options);
    const TrialAnswer found = answer(scan);
    Trial trial;
    trial.bin = bin.number;
    trial.number = static_cast<int>(i);
    trial.search = gradePose(model, scan, found.search);
    trial.unlimited = gradePose(model, scan, found.unlimited);
    trial.rough = gradePose(model, scan, found.rough);
    trial.fine = gradePose(model, scan, found.fine);
    trial.score = found.score;
    trial.times = found.times;
    const int best = mostVisible(scan);
    trial.best_visible = scan.visible_fractions[static_cast<std::size_t>(best)];
    const int taken = trial.fine.part >= 0 ? trial.fine.part : best;
    if (trial.fine.part >= 0) {
      trial.visible = scan.visible_fractions[static_cast<std::size_t>(taken)];
    }
    if (observe) observe(trial, scan, found);
    left[static_cast<std::size_t>(scan.parts[static_cast<std::size_t>(taken)])] = false;
    trials.push_back(std::move(trial));
  }
  return trials;
}

}  // namespace rangepose
