#include "pipeline/dropouts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace rangepose {
namespace {

/// What is measured around a pixel.
struct Around {
  int measured = 0;  ///< of the eight neighbours
  float low_mm = std::numeric_limits<float>::max();
  float high_mm = 0.0f;
  double mean_mm = 0.0;  ///< of neighbours on opposite sides, where both are measured
};

Around lookAround(const Image<float>& depth_mm, int u, int v) {
  constexpr std::array<std::array<int, 2>, 4> kAcross{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  Around around;
  double sum_mm = 0.0;
  int paired = 0;
  for (const auto& [du, dv] : kAcross) {
    const float before = depth_mm.at(u - du, v - dv);
    const float after = depth_mm.at(u + du, v + dv);
    for (const float one : {before, after}) {
      if (one == 0.0f) continue;
      ++around.measured;
      around.low_mm = std::min(around.low_mm, one);
      around.high_mm = std::max(around.high_mm, one);
    }
    if (before == 0.0f || after == 0.0f) continue;
    sum_mm += static_cast<double>(after) + static_cast<double>(before);
    paired += 2;
  }
  if (paired > 0) around.mean_mm = sum_mm / paired;
  return around;
}

}  // namespace

DepthImage fillDropouts(const DepthImage& image, double noise_mm) {
  constexpr double kMany = 0.02;     // of the measured pixels; simulated sensors lose 0.2 or 8 %
  constexpr int kMeasured = 6;       // at least: then two opposite ones are among them
  constexpr double kSteepest = 1.0;  // slope of a surface that is no edge and not seen at a slant
  constexpr double kSigmas = 5.0;    // between the nearest and the farthest of the neighbours
  const Image<float>& seen = image.depth_mm;
  DepthImage filled = image;
  int lost = 0;
  for (int v = 1; v + 1 < seen.height(); ++v) {
    for (int u = 1; u + 1 < seen.width(); ++u) {
      if (seen.at(u, v) != 0.0f) continue;
      const Around around = lookAround(seen, u, v);
      if (around.measured < kMeasured) continue;
      const double apart_mm =
          2.0 * std::numbers::sqrt2 * image.camera.pixelSpacingMm(around.low_mm);
      const double most_mm = kSteepest * apart_mm + kSigmas * noise_mm;
      if (static_cast<double>(around.high_mm - around.low_mm) > most_mm) continue;
      filled.depth_mm.at(u, v) = static_cast<float>(around.mean_mm);
      ++lost;
    }
  }
  const auto all = std::count_if(seen.begin(), seen.end(), [](float mm) { return mm > 0.0f; });
  if (!(lost > kMany * static_cast<double>(all))) return image;
  return filled;
}

}  // namespace rangepose
