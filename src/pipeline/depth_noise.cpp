#include "pipeline/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rangepose {

double estimateDepthNoise(const DepthImage& image, const Image<std::uint8_t>& mask) {
  // Neighbours of stereo and interpolated images share their noise: points some pixels apart do
  // not.
  constexpr int kApart = 3;
  std::vector<float> differences;
  for (int v = 0; v < mask.height(); v += 2) {
    for (int u = kApart; u + kApart < mask.width(); ++u) {
      if (mask.at(u - kApart, v) == 0 || mask.at(u, v) == 0 || mask.at(u + kApart, v) == 0)
        continue;
      const float* row = image.depth_mm.row(v);
      if (row[u - kApart] == 0.0f || row[u] == 0.0f || row[u + kApart] == 0.0f) continue;
      differences.push_back(std::abs(row[u - kApart] - 2.0f * row[u] + row[u + kApart]));
    }
  }
  if (differences.size() < 100) return 0.0;
  // The mean of the lower half: steps and bends of the surface are in the upper one, and unlike a
  // quantile it does not vanish when depth is quantised.
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  double sum = 0.0;
  for (auto it = differences.begin(); it != middle; ++it) sum += static_cast<double>(*it);
  // For x from N(0, s^2) the mean of the lower half of |x| is 0.3247 s; here s = sqrt(6) sigma.
  return sum / static_cast<double>(middle - differences.begin()) / (0.3247 * std::sqrt(6.0));
}

}  // namespace rangepose
