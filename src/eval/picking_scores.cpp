#include "eval/picking_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/error.h"

namespace rangepose {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double share(int count, int all) { return all == 0 ? kNothing : static_cast<double>(count) / all; }

double median(std::vector<double> values) {
  if (values.empty()) return kNothing;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

bool isOf(const ObjectErrors& image, const std::optional<int>& obj_id) {
  return !obj_id || image.obj_id == *obj_id;
}

int partsToFind(const ObjectErrors& image, double min_visible) {
  return static_cast<int>(std::count_if(image.visible_fractions.begin(),
                                        image.visible_fractions.end(),
                                        [&](double visible) { return visible >= min_visible; }));
}

enum class Verdict { kFound, kIgnored, kFalse };

struct Judged {
  double score = 0.0;
  Verdict verdict = Verdict::kFalse;
};

std::vector<Judged> judge(const ObjectErrors& image,
                          const PairErrors& errors,
                          double limit,
                          double min_visible) {
  std::vector<Judged> judged;
  const std::vector<int> matches = matchGreedily(errors, limit);
  for (std::size_t i = 0; i < image.scores.size(); ++i) {
    const int match = errors.empty() ? kUnmatched : matches[i];
    Verdict verdict = Verdict::kFalse;
    if (match != kUnmatched) {
      const bool counts = image.visible_fractions[static_cast<std::size_t>(match)] >= min_visible;
      verdict = counts ? Verdict::kFound : Verdict::kIgnored;
    }
    judged.push_back({image.scores[i], verdict});
  }
  return judged;
}

void append(std::vector<Judged>& judged, const std::vector<Judged>& more) {
  judged.insert(judged.end(), more.begin(), more.end());
}

int countOf(const std::vector<Judged>& judged, Verdict verdict) {
  return static_cast<int>(std::count_if(
      judged.begin(), judged.end(), [&](const Judged& one) { return one.verdict == verdict; }));
}

/// MSSD, but just right where poses look the same [diameters].
PairErrors errorsAsSeen(const ObjectErrors& image, const PickingOptions& options) {
  const double just_right = std::nextafter(options.right, 0.0);
  PairErrors errors = image.mssd;
  auto unlike = image.unlike.begin();
  for (double& error : errors) {
    if (*unlike++ < options.unlike) error = std::min(error, just_right);
  }
  return errors;
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
  scores.first_pick = share(right, scores.images);
  scores.first_pick_strict = share(strict, scores.images);
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
  scores.median_mssd = median(std::move(mssd));
  scores.median_rotation_rad = median(std::move(rotation));
  scores.median_translation_mm = median(std::move(translation));
}

/// `judged` by falling score. Points only after the last estimate of a score: their order is
/// chance.
std::vector<PrecisionRecall> curveOf(const std::vector<Judged>& judged, int parts) {
  std::vector<PrecisionRecall> curve;
  int found = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    found += judged[i].verdict == Verdict::kFound ? 1 : 0;
    wrong += judged[i].verdict == Verdict::kFalse ? 1 : 0;
    if (i + 1 < judged.size() && judged[i + 1].score == judged[i].score) continue;
    if (found + wrong == 0) continue;
    curve.push_back({judged[i].score, share(found, found + wrong), share(found, parts)});
  }
  return curve;
}

/// Area under the curve, where a precision counts from the largest recall that reaches it
/// downwards.
double averagePrecision(const std::vector<PrecisionRecall>& curve) {
  double area = 0.0;
  double best = 0.0;
  for (std::size_t i = curve.size(); i-- > 0;) {
    best = std::max(best, curve[i].precision);
    area += best * (curve[i].recall - (i > 0 ? curve[i - 1].recall : 0.0));
  }
  return area;
}

void scoreAsSeen(const std::vector<ObjectErrors>& images,
                 const PickingOptions& options,
                 const std::optional<int>& obj_id,
                 PickingScores& scores) {
  std::vector<Judged> judged;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    append(judged, judge(image, errorsAsSeen(image, options), options.right, options.min_visible));
  }
  const int found = countOf(judged, Verdict::kFound);
  scores.recall_as_seen = share(found, scores.parts);
  scores.precision_as_seen = share(found, found + countOf(judged, Verdict::kFalse));
}

std::vector<ReliabilityBin> reliabilityOf(const std::vector<Judged>& judged) {
  constexpr int kBins = 10;
  std::vector<ReliabilityBin> bins(kBins);
  for (int i = 0; i < kBins; ++i) {
    bins[static_cast<std::size_t>(i)].low = static_cast<double>(i) / kBins;
    bins[static_cast<std::size_t>(i)].high = static_cast<double>(i + 1) / kBins;
  }
  for (const Judged& estimate : judged) {
    if (!(estimate.score >= 0.0 && estimate.score <= 1.0)) return {};
    const int index = std::min(kBins - 1, static_cast<int>(estimate.score * kBins));
    ReliabilityBin& bin = bins[static_cast<std::size_t>(index)];
    ++bin.count;
    bin.mean_score += estimate.score;
    bin.right += estimate.verdict != Verdict::kFalse ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : bins) {
    bin.mean_score = bin.count == 0 ? kNothing : bin.mean_score / bin.count;
    bin.right = bin.count == 0 ? kNothing : bin.right / bin.count;
  }
  return bins;
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
  std::vector<Judged> judged;
  for (const ObjectErrors& image : images) {
    if (!isOf(image, obj_id)) continue;
    scores.parts += partsToFind(image, options.min_visible);
    append(judged, judge(image, image.mssd, options.right, options.min_visible));
  }
  std::stable_sort(judged.begin(), judged.end(), [](const Judged& a, const Judged& b) {
    return a.score > b.score;
  });
  scores.estimates = static_cast<int>(judged.size());
  scores.ignored = countOf(judged, Verdict::kIgnored);
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
    found += countOf(judge(image, image.mssd, limit, min_visible), Verdict::kFound);
  }
  return share(found, parts);
}

}  // namespace rangepose
