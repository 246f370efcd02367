#include "stages/noise_host.h"

#include <algorithm>
#include <vector>

#include "stages/noise_core.h"

namespace rangepose::host {

double depthNoise(const DepthImage& image, const Image<std::uint8_t>& mask) {
  std::vector<float> differences;
  for (int v = 0; v < mask.height(); v += kNoiseRowStep) {
    for (int u = kNoiseApart; u + kNoiseApart < mask.width(); ++u) {
      if (mask.at(u - kNoiseApart, v) == 0 || mask.at(u, v) == 0 ||
          mask.at(u + kNoiseApart, v) == 0)
        continue;
      const float* row = image.depth_mm.row(v);
      const float difference = secondDifference(row[u - kNoiseApart], row[u], row[u + kNoiseApart]);
      if (difference >= 0.0f) differences.push_back(difference);
    }
  }
  if (differences.size() < kNoiseFewest) return 0.0;
  // The mean of the lower half: steps and bends of the surface are in the upper one, and unlike a
  // quantile it does not vanish when depth is quantised.
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  double sum = 0.0;
  for (auto it = differences.begin(); it != middle; ++it) sum += static_cast<double>(*it);
  return noiseOfLowerHalf(sum, static_cast<double>(middle - differences.begin()));
}

}  // namespace rangepose::host
