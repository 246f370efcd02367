#include "eval/gate_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rangepose {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

using ByImage = std::map<ImageId, std::vector<ObjectErrors>>;

ByImage byImage(const std::vector<ObjectErrors>& all, const std::set<int>& objects) {
  ByImage images;
  for (const ObjectErrors& errors : all) {
    if (objects.contains(errors.obj_id)) images[{errors.scene_id, errors.im_id}].push_back(errors);
  }
  return images;
}

bool holdsNone(const std::vector<ObjectErrors>& image) {
  return std::all_of(image.begin(), image.end(), [](const ObjectErrors& errors) {
    return errors.visible_fractions.empty();
  });
}

void append(std::vector<JudgedPose>& judged, const std::vector<JudgedPose>& more) {
  judged.insert(judged.end(), more.begin(), more.end());
}

ImageTally tallyOf(const std::vector<ObjectErrors>& shown,
                   const std::vector<ObjectErrors>& checked,
                   const PickingOptions& options) {
  ImageTally tally;
  tally.holds_none = holdsNone(shown);
  for (const ObjectErrors& errors : shown) {
    tally.parts += partsToFind(errors, options.min_visible);
    append(tally.shown, judgePoses(errors, errors.mssd, options.right, options.min_visible));
    const std::vector<JudgedPose> as_seen =
        judgePoses(errors, errorsAsSeen(errors, options), options.right, options.min_visible);
    tally.found_as_seen += countOf(as_seen, PoseVerdict::kFound);
    tally.false_as_seen += countOf(as_seen, PoseVerdict::kFalse);
  }
  for (const ObjectErrors& errors : checked) {
    append(tally.checked, judgePoses(errors, errors.mssd, options.right, options.min_visible));
  }
  if (tally.parts > 0) tally.first_right = pickingScores(shown, options).first_pick == 1.0;
  return tally;
}

bool isRight(const JudgedPose& pose) { return pose.verdict != PoseVerdict::kFalse; }

double meanOf(double sum, int count) { return count == 0 ? kNothing : sum / count; }

void fillCounts(const std::vector<const ImageTally*>& tallies, GateFigures& figures) {
  int first = 0;
  int first_right = 0;
  int none_poses = 0;
  int found_as_seen = 0;
  int false_as_seen = 0;
  std::vector<double> times;
  for (const ImageTally* tally : tallies) {
    ++figures.images;
    figures.parts += tally->parts;
    first += tally->first_right ? 1 : 0;
    first_right += tally->first_right.value_or(false) ? 1 : 0;
    figures.none_images += tally->holds_none ? 1 : 0;
    none_poses += tally->holds_none ? static_cast<int>(tally->shown.size()) : 0;
    found_as_seen += tally->found_as_seen;
    false_as_seen += tally->false_as_seen;
    if (!std::isnan(tally->time_s)) times.push_back(tally->time_s);
  }
  figures.first_pick = shareOf(first_right, first);
  figures.none_poses = meanOf(none_poses, figures.none_images);
  figures.recall_as_seen = shareOf(found_as_seen, figures.parts);
  figures.precision_as_seen = shareOf(found_as_seen, found_as_seen + false_as_seen);
  figures.time_s = medianOf(std::move(times));
}

void fillShown(const std::vector<JudgedPose>& shown, GateFigures& figures) {
  const int found = countOf(shown, PoseVerdict::kFound);
  figures.recall = shareOf(found, figures.parts);
  figures.precision = shareOf(found, found + countOf(shown, PoseVerdict::kFalse));
  int right = 0;
  std::vector<double> errors;
  for (const JudgedPose& pose : shown) {
    if (isRight(pose)) errors.push_back(pose.error);
    if (!(pose.score > kSure)) continue;
    ++figures.sure;
    right += isRight(pose) ? 1 : 0;
  }
  figures.sure_right = shareOf(right, figures.sure);
  figures.median_mssd = medianOf(std::move(errors));
}

/// Brier score, calibration error and mean scores: what the scores are worth as probabilities.
void fillScores(const std::vector<JudgedPose>& checked, GateFigures& figures) {
  figures.reliability = reliabilityOf(checked);
  double squares = 0.0;
  double right_sum = 0.0;
  double wrong_sum = 0.0;
  int right = 0;
  for (const JudgedPose& pose : checked) {
    const double is_right = isRight(pose) ? 1.0 : 0.0;
    squares += (pose.score - is_right) * (pose.score - is_right);
    right += isRight(pose) ? 1 : 0;
    (isRight(pose) ? right_sum : wrong_sum) += pose.score;
  }
  figures.checked = static_cast<int>(checked.size());
  figures.mean_right = meanOf(right_sum, right);
  figures.mean_wrong = meanOf(wrong_sum, figures.checked - right);
  figures.brier = figures.calibration_error = kNothing;
  if (figures.reliability.empty()) return;
  figures.brier = meanOf(squares, figures.checked);
  double gaps = 0.0;
  for (const ReliabilityBin& bin : figures.reliability) {
    if (bin.count > 0) gaps += bin.count * std::abs(bin.mean_score - bin.right);
  }
  figures.calibration_error = meanOf(gaps, figures.checked);
}

}  // namespace

std::map<ImageId, double> timesOf(const std::vector<BopEstimate>& rows) {
  std::map<ImageId, double> times;
  for (const BopEstimate& row : rows) {
    if (row.time_s >= 0.0) times[{row.scene_id, row.im_id}] = row.time_s;
  }
  return times;
}

std::vector<ObjectErrors> wrongPoses(const std::vector<BopEstimate>& rows) {
  std::map<std::pair<ImageId, int>, ObjectErrors> images;
  for (const BopEstimate& row : rows) {
    ObjectErrors& errors = images[{{row.scene_id, row.im_id}, row.obj_id}];
    errors.scene_id = row.scene_id;
    errors.im_id = row.im_id;
    errors.obj_id = row.obj_id;
    errors.scores.push_back(row.score);
  }
  std::vector<ObjectErrors> wrong;
  for (auto& [key, errors] : images) {
    std::stable_sort(errors.scores.begin(), errors.scores.end(), std::greater<>());
    errors.mssd = errors.unlike = PairErrors(0, static_cast<int>(errors.scores.size()));
    wrong.push_back(std::move(errors));
  }
  return wrong;
}

std::vector<ImageTally> tallyImages(const GradedRun& run,
                                    const std::set<int>& objects,
                                    const PickingOptions& options) {
  options.check();
  const ByImage shown = byImage(run.shown, objects);
  const ByImage checked = byImage(run.checked, objects);
  const auto of = [](const ByImage& images, const ImageId& id) {
    const auto found = images.find(id);
    return found == images.end() ? std::vector<ObjectErrors>() : found->second;
  };
  std::vector<ImageTally> tallies;
  for (const ImageId& id : run.images) {
    tallies.push_back(tallyOf(of(shown, id), of(checked, id), options));
    tallies.back().id = id;
    const auto time = run.times_s.find(id);
    tallies.back().time_s = time == run.times_s.end() ? kNothing : time->second;
  }
  return tallies;
}

GateFigures gateFigures(const std::vector<const ImageTally*>& tallies) {
  GateFigures figures;
  std::vector<JudgedPose> shown;
  std::vector<JudgedPose> checked;
  for (const ImageTally* tally : tallies) {
    append(shown, tally->shown);
    append(checked, tally->checked);
  }
  fillCounts(tallies, figures);
  fillShown(shown, figures);
  fillScores(checked, figures);
  figures.recall_checked = shareOf(countOf(checked, PoseVerdict::kFound), figures.parts);
  figures.average_precision = kNothing;
  if (figures.parts > 0) {
    sortByScore(checked);
    figures.average_precision = averagePrecision(curveOf(checked, figures.parts));
  }
  return figures;
}

GateFigures gateFigures(const std::vector<ImageTally>& tallies) {
  std::vector<const ImageTally*> pointers;
  pointers.reserve(tallies.size());
  for (const ImageTally& tally : tallies) pointers.push_back(&tally);
  return gateFigures(pointers);
}

}  // namespace rangepose
