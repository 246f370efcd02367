#include "eval/picking_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/error.h"
#include "eval/judged_poses.h"

namespace rangepose {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool isOf(const ObjectErrors& image, const std::optional<int>& obj_id) {
  return !obj_id || image.obj_id == *obj_id;
}

void append(std::vector<JudgedPose>& judged, const std::vector<JudgedPose>& more) {
  judged.insert(judged.end(), more.begin(), more.end());
}

/// What happened to the estimate with the top score of an image.
struct FirstPick {
  double score = -std::numeric_limits<double>::infinity();
  double mssd = std::numeric_limits<double>::infinity();
  int parts = 0;
};

void scoreFirstPicks(const std::vector<ObjectErrors>& images,
                     const PickingOptions& options,
                     const std::optional<int>& obj_id,
                     PickingScores& scores) {
  std::map<std::pair<int, int>, FirstPick> picks;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    FirstPick& pick = picks[{image.scene_id, image.im_id}];
    pick.parts += partsToFind(image, options.min_visible);
    if (image.scores.empty() || image.scores.front() <= pick.score) continue;
    pick.score = image.scores.front();
    pick.mssd = std::numeric_limits<double>::infinity();
    for (int x = 0; x < image.mssd.width(); ++x) {
      pick.mssd = std::min(pick.mssd, image.mssd.at(x, 0));
    }
  }
  int right = 0;
  int strict = 0;
  for (const auto& [image, pick] : picks) {
    if (pick.parts == 0) continue;
    ++scores.images;
    right += pick.mssd < options.right ? 1 : 0;
    strict += pick.mssd < options.strict ? 1 : 0;
  }
  scores.first_pick = shareOf(right, scores.images);
  scores.first_pick_strict = shareOf(strict, scores.images);
}

void scoreMedians(const std::vector<ObjectErrors>& images,
                  const PickingOptions& options,
                  const std::optional<int>& obj_id,
                  PickingScores& scores) {
  std::vector<double> mssd;
  std::vector<double> rotation;
  std::vector<double> translation;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    const std::vector<int> matches = matchGreedily(image.mssd, options.right);
    for (int row = 0; row < image.mssd.height(); ++row) {
      const int match = matches[static_cast<std::size_t>(row)];
      if (match == kUnmatched) continue;
      mssd.push_back(image.mssd.at(match, row));
      rotation.push_back(image.rotation_rad.at(match, row));
      translation.push_back(image.translation_mm.at(match, row));
    }
  }
  scores.median_mssd = medianOf(std::move(mssd));
  scores.median_rotation_rad = medianOf(std::move(rotation));
  scores.median_translation_mm = medianOf(std::move(translation));
}

void scoreAsSeen(const std::vector<ObjectErrors>& images,
                 const PickingOptions& options,
                 const std::optional<int>& obj_id,
                 PickingScores& scores) {
  std::vector<JudgedPose> judged;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    append(judged,
           judgePoses(image, errorsAsSeen(image, options), options.right, options.min_visible));
  }
  const int found = countOf(judged, PoseVerdict::kFound);
  scores.recall_as_seen = shareOf(found, scores.parts);
  scores.precision_as_seen = shareOf(found, found + countOf(judged, PoseVerdict::kFalse));
}

}  // namespace

void PickingOptions::check() const {
  RP_CHECK(right > 0.0 && right <= 0.1, "picking: right must lie in 0..0.1");
  RP_CHECK(strict > 0.0 && strict <= right, "picking: strict must be positive and at most right");
  RP_CHECK(unlike >= 0.0 && unlike <= 1.0, "picking: unlike must lie in 0..1");
  RP_CHECK(min_visible >= 0.0 && min_visible <= 1.0, "picking: min_visible must lie in 0..1");
}

PickingScores pickingScores(const std::vector<ObjectErrors>& images,
                            const PickingOptions& options,
                            const std::optional<int>& obj_id) {
  options.check();
  PickingScores scores;
  std::vector<JudgedPose> judged;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    scores.parts += partsToFind(image, options.min_visible);
    append(judged, judgePoses(image, image.mssd, options.right, options.min_visible));
  }
  sortByScore(judged);
  scores.estimates = static_cast<int>(judged.size());
  scores.ignored = countOf(judged, PoseVerdict::kIgnored);
  scores.curve = curveOf(judged, scores.parts);
  scores.recall = scores.recall_at_99 = scores.average_precision =
      scores.parts == 0 ? kNothing : 0.0;
  scores.precision = scores.curve.empty() ? kNothing : scores.curve.back().precision;
  if (!scores.curve.empty() && scores.parts > 0) {
    scores.recall = scores.curve.back().recall;
    scores.average_precision = averagePrecision(scores.curve);
    for (const PrecisionRecall& point : scores.curve) {
      if (point.precision >= 0.99)
        scores.recall_at_99 = std::max(scores.recall_at_99, point.recall);
    }
  }
  scores.recall_strict = recallAt(images, options.strict, options.min_visible, obj_id);
  scores.reliability = reliabilityOf(judged);
  scoreAsSeen(images, options, obj_id, scores);
  scoreFirstPicks(images, options, obj_id, scores);
  scoreMedians(images, options, obj_id, scores);
  return scores;
}

double recallAt(const std::vector<ObjectErrors>& images,
                double limit,
                double min_visible,
                const std::optional<int>& obj_id) {
  int parts = 0;
  int found = 0;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    parts += partsToFind(image, min_visible);
    found += countOf(judgePoses(image, image.mssd, limit, min_visible), PoseVerdict::kFound);
  }
  return shareOf(found, parts);
}

}  // namespace rangepose
