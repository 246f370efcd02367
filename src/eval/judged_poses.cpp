#include "eval/judged_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rangepose {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double shareOf(int count, int all) {
  return all == 0 ? kNothing : static_cast<double>(count) / all;
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return kNothing;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

int partsToFind(const ObjectErrors& image, double min_visible) {
  return static_cast<int>(std::count_if(image.visible_fractions.begin(),
                                        image.visible_fractions.end(),
                                        [&](double visible) { return visible >= min_visible; }));
}

std::vector<JudgedPose> judgePoses(const ObjectErrors& image,
                                   const PairErrors& errors,
                                   double limit,
                                   double min_visible) {
  std::vector<JudgedPose> judged;
  judged.reserve(image.scores.size());
  const std::vector<int> matches = matchGreedily(errors, limit);
  for (std::size_t i = 0; i < image.scores.size(); ++i) {
    const int match = errors.empty() ? kUnmatched : matches[i];
    JudgedPose pose{image.scores[i], PoseVerdict::kFalse, kNothing};
    if (match != kUnmatched) {
      const bool counts = image.visible_fractions[static_cast<std::size_t>(match)] >= min_visible;
      pose.verdict = counts ? PoseVerdict::kFound : PoseVerdict::kIgnored;
      pose.error = errors.at(match, static_cast<int>(i));
    }
    judged.push_back(pose);
  }
  return judged;
}

PairErrors errorsAsSeen(const ObjectErrors& image, const PickingOptions& options) {
  const double just_right = std::nextafter(options.right, 0.0);
  PairErrors errors = image.mssd;
  auto unlike = image.unlike.begin();
  for (double& error : errors) {
    if (*unlike++ < options.unlike) error = std::min(error, just_right);
  }
  return errors;
}

int countOf(const std::vector<JudgedPose>& judged, PoseVerdict verdict) {
  return static_cast<int>(std::count_if(
      judged.begin(), judged.end(), [&](const JudgedPose& one) { return one.verdict == verdict; }));
}

void sortByScore(std::vector<JudgedPose>& judged) {
  std::stable_sort(judged.begin(), judged.end(), [](const JudgedPose& a, const JudgedPose& b) {
    return a.score > b.score;
  });
}

std::vector<PrecisionRecall> curveOf(const std::vector<JudgedPose>& judged, int parts) {
  std::vector<PrecisionRecall> curve;
  int found = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    found += judged[i].verdict == PoseVerdict::kFound ? 1 : 0;
    wrong += judged[i].verdict == PoseVerdict::kFalse ? 1 : 0;
    if (i + 1 < judged.size() && judged[i + 1].score == judged[i].score) continue;
    if (found + wrong == 0) continue;
    curve.push_back({judged[i].score, shareOf(found, found + wrong), shareOf(found, parts)});
  }
  return curve;
}

double averagePrecision(const std::vector<PrecisionRecall>& curve) {
  double area = 0.0;
  double best = 0.0;
  for (std::size_t i = curve.size(); i-- > 0;) {
    best = std::max(best, curve[i].precision);
    area += best * (curve[i].recall - (i > 0 ? curve[i - 1].recall : 0.0));
  }
  return area;
}

std::vector<ReliabilityBin> reliabilityOf(const std::vector<JudgedPose>& judged) {
  constexpr int kBins = 10;
  std::vector<ReliabilityBin> bins(kBins);
  for (int i = 0; i < kBins; ++i) {
    bins[static_cast<std::size_t>(i)].low = static_cast<double>(i) / kBins;
    bins[static_cast<std::size_t>(i)].high = static_cast<double>(i + 1) / kBins;
  }
  for (const JudgedPose& estimate : judged) {
    if (!(estimate.score >= 0.0 && estimate.score <= 1.0)) return {};
    const int index = std::min(kBins - 1, static_cast<int>(estimate.score * kBins));
    ReliabilityBin& bin = bins[static_cast<std::size_t>(index)];
    ++bin.count;
    bin.mean_score += estimate.score;
    bin.right += estimate.verdict != PoseVerdict::kFalse ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : bins) {
    bin.mean_score = bin.count == 0 ? kNothing : bin.mean_score / bin.count;
    bin.right = bin.count == 0 ? kNothing : bin.right / bin.count;
  }
  return bins;
}

}  // namespace rangepose
