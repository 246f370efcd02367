#include "eval/scan_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rangepose {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Sorts the values; the lower one where the share falls between two.
double quantile(std::vector<float>& values, double share) {
  if (values.empty()) return kNan;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double ratio(double sum, long long count) {
  return count == 0 ? kNan : sum / static_cast<double>(count);
}

void fillErrors(const SurfaceErrorTally& tally, ScanStatistics& figures) {
  figures.pixels = tally.pixels;
  figures.noise_mm = noiseBetweenNeighbours(tally.second_mm);
  figures.rms_mm = std::sqrt(ratio(tally.squares, tally.pixels));
  figures.deep_rms_mm = std::sqrt(ratio(tally.deep_squares, tally.deep_pixels));
  figures.mean_size_mm = ratio(tally.sizes, tally.pixels);
  for (std::size_t i = 0; i < tally.pairs.size(); ++i) {
    const ErrorPairs& pairs = tally.pairs[i];
    figures.difference_mm[i] = std::sqrt(ratio(pairs.half_squares, pairs.count));
    figures.correlation[i] =
        pairs.mean_squares > 0.0 ? 1.0 - pairs.half_squares / pairs.mean_squares : kNan;
  }
}

void fillJumps(const JumpTally& tally, ScanStatistics& figures) {
  figures.profiles = tally.profiles;
  figures.smear_px = ratio(static_cast<double>(tally.smeared_px), tally.profiles);
  std::vector<float> passing;
  long long all = 0;
  for (std::size_t i = 0; i < tally.sides.size(); ++i) {
    const SideTally& side = tally.sides[i];
    std::vector<float> own = side.passing_px;
    passing.insert(passing.end(), own.begin(), own.end());
    all += side.profiles;
    figures.sides[i] = {side.profiles,
                        quantile(own, 0.5),
                        ratio(static_cast<double>(side.hole_px), side.profiles),
                        ratio(static_cast<double>(side.wide_holes), side.profiles)};
  }
  figures.passing_px = quantile(passing, 0.5);
  figures.passing_spread_px = 0.5 * (quantile(passing, 0.84) - quantile(passing, 0.16));
  for (std::size_t i = 0; i < tally.fractions.size(); ++i) {
    std::vector<float> fractions = tally.fractions[i];
    const auto measured = static_cast<double>(fractions.size());
    figures.places[i] = {quantile(fractions, 0.5), ratio(static_cast<double>(all) - measured, all)};
  }
}

}  // namespace

void ScanTally::add(const ScanTally& other) {
  images += other.images;
  parts += other.parts;
  errors.add(other.errors);
  jumps.add(other.jumps);
  lost.add(other.lost);
  steps.add(other.steps);
}

ScanTally tallyScan(const DepthImage& image, const std::vector<KnownPart>& parts) {
  const KnownSurface known = renderKnown(parts, image.camera);
  ScanTally tally;
  tally.images = 1;
  tally.parts = static_cast<int>(std::count_if(
      parts.begin(), parts.end(), [](const KnownPart& part) { return part.counted; }));
  tally.errors = tallySurfaceErrors(surfaceErrors(image, known, parts), known);
  tally.jumps = tallyJumps(jumpProfiles(image, known, parts));
  tally.lost = tallyLost(image, known, parts);
  tally.steps = depthSteps(image, known, parts);
  return tally;
}

ScanStatistics statisticsOf(const ScanTally& tally) {
  ScanStatistics figures;
  figures.images = tally.images;
  figures.parts = tally.parts;
  fillErrors(tally.errors, figures);
  fillJumps(tally.jumps, figures);
  for (std::size_t i = 0; i < figures.lost_by_slant.size(); ++i) {
    figures.lost_by_slant[i] = tally.lost.by_slant[i].share();
  }
  figures.lost_share = tally.lost.silhouettes.share();
  figures.common_step_mm = tally.steps.commonStepMm();
  std::vector<float> gaps = tally.steps.gaps_mm;
  figures.gap_mm = quantile(gaps, 0.5);
  return figures;
}

}  // namespace rangepose
