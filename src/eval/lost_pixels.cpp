#include "eval/lost_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace rangepose {
namespace {

bool isCounted(const KnownPixel& pixel, const std::vector<KnownPart>& parts) {
  return pixel.part >= 0 && parts[static_cast<std::size_t>(pixel.part)].counted;
}

bool isHidden(const KnownPixel& pixel, double measured_mm, const std::vector<KnownPart>& parts) {
  return measured_mm > 0.0 && (pixel.depth_mm - measured_mm) * pixel.cosine >
                                  agreementMm(parts[static_cast<std::size_t>(pixel.part)]);
}

}  // namespace

void LostShare::add(const LostShare& other) {
  pixels += other.pixels;
  lost += other.lost;
}

double LostShare::share() const {
  return pixels == 0 ? std::numeric_limits<double>::quiet_NaN()
                     : static_cast<double>(lost) / static_cast<double>(pixels);
}

void LostTally::add(const LostTally& other) {
  for (std::size_t i = 0; i < by_slant.size(); ++i) by_slant[i].add(other.by_slant[i]);
  silhouettes.add(other.silhouettes);
}

LostTally tallyLost(const DepthImage& image,
                    const KnownSurface& known,
                    const std::vector<KnownPart>& parts) {
  LostTally tally;
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      const KnownPixel& pixel = known.at(u, v);
      const double measured = image.depth_mm.at(u, v);
      if (!isCounted(pixel, parts) || isHidden(pixel, measured, parts)) continue;
      const LostShare one{1, measured == 0.0 ? 1 : 0};
      tally.silhouettes.add(one);
      if (!pixel.inner()) continue;
      const double bins = static_cast<double>(tally.by_slant.size());
      const double slant = std::acos(static_cast<double>(pixel.cosine)) / (0.5 * std::numbers::pi);
      tally.by_slant[static_cast<std::size_t>(std::min(bins * slant, bins - 1.0))].add(one);
    }
  }
  return tally;
}

void DepthSteps::add(const DepthSteps& other) {
  for (const auto& [depth_um, count] : other.counts) counts[depth_um] += count;
  gaps_mm.insert(gaps_mm.end(), other.gaps_mm.begin(), other.gaps_mm.end());
}

double DepthSteps::commonStepMm() const {
  constexpr int kLargestUm = 10000;
  constexpr double kOthers = 0.05;
  if (counts.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<std::pair<long long, long long>> values(counts.begin(), counts.end());
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return a.second > b.second;  // the frequent ones first: they settle it sooner
  });
  double all = 0.0;
  for (const auto& [depth_um, count] : values) all += static_cast<double>(count);
  const auto isCommon = [&](int step_um) {
    double others = 0.0;
    for (const auto& [depth_um, count] : values) {
      others += depth_um % step_um == 0 ? 0.0 : static_cast<double>(count);
      if (others > kOthers * all) return false;
    }
    return true;
  };
  int step_um = kLargestUm;
  while (!isCommon(step_um)) --step_um;
  return 1e-3 * step_um;
}

DepthSteps depthSteps(const DepthImage& image,
                      const KnownSurface& known,
                      const std::vector<KnownPart>& parts) {
  DepthSteps steps;
  std::vector<float> values;
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      const float measured = image.depth_mm.at(u, v);
      if (measured == 0.0f) continue;
      ++steps.counts[std::llround(1000.0 * measured)];
      const KnownPixel& pixel = known.at(u, v);
      if (!pixel.inner() || !isCounted(pixel, parts)) continue;
      const double off = std::abs(measured - pixel.depth_mm) * pixel.cosine;
      if (off <= agreementMm(parts[static_cast<std::size_t>(pixel.part)])) {
        values.push_back(measured);
      }
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  for (std::size_t i = 1; i < values.size(); ++i) {
    steps.gaps_mm.push_back(values[i] - values[i - 1]);
  }
  return steps;
}

}  // namespace rangepose
