#include "pipeline/dropouts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace rangepose {

namespace {

/// The eight neighbours of a pixel, opposite ones one after the other.
constexpr std::array<std::array<int, 2>, 8> kAround{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};

}  // namespace

DepthImage fillDropouts(const DepthImage& image, double noise_mm) {
  constexpr double kMany = 0.02;     // of the measured pixels; simulated sensors lose 0.2 or 8 %
  constexpr int kMeasured = 6;       // at least, of the eight neighbours
  constexpr double kSteepest = 1.0;  // slope of a surface that is no edge and not seen at a slant
  constexpr double kSigmas = 5.0;    // between the nearest and the farthest of the neighbours
  const Image<float>& seen = image.depth_mm;
  DepthImage filled = image;
  int lost = 0;
  for (int v = 1; v + 1 < seen.height(); ++v) {
    for (int u = 1; u + 1 < seen.width(); ++u) {
      if (seen.at(u, v) != 0.0f) continue;
      float low = std::numeric_limits<float>::max();
      float high = 0.0f;
      int measured = 0;
      double sum = 0.0;
      int paired = 0;
      for (std::size_t i = 0; i < kAround.size(); i += 2) {
        const float a = seen.at(u + kAround[i][0], v + kAround[i][1]);
        const float b = seen.at(u + kAround[i + 1][0], v + kAround[i + 1][1]);
        for (const float one : {a, b}) {
          if (one == 0.0f) continue;
          ++measured;
          low = std::min(low, one);
          high = std::max(high, one);
        }
        if (a == 0.0f || b == 0.0f) continue;
        sum += static_cast<double>(a) + static_cast<double>(b);
        paired += 2;
      }
      if (measured < kMeasured || paired == 0) continue;
      const double apart_mm = 2.0 * std::numbers::sqrt2 * image.camera.pixelSpacingMm(low);
      const double most_mm = kSteepest * apart_mm + kSigmas * noise_mm;
      if (static_cast<double>(high - low) > most_mm) continue;
      filled.depth_mm.at(u, v) = static_cast<float>(sum / paired);
      ++lost;
    }
  }
  const auto all = std::count_if(seen.begin(), seen.end(), [](float mm) { return mm > 0.0f; });
  return lost > kMany * static_cast<double>(all) ? filled : image;
}

}  // namespace rangepose
