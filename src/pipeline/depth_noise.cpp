#include "pipeline/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rangepose {

double estimateDepthNoise(const DepthImage& image, const Image<std::uint8_t>& mask) {
  // Neighbours of stereo and interpolated images share their noise: points some pixels apart do not.
  constexpr int kApart = 3;
  std::vector<float> differences;
  for (int v = 0; v < mask.height(); v += 2) {
    for (int u = kApart; u + kApart < mask.width(); ++u) {
      if (mask.at(u - kApart, v) == 0 || mask.at(u, v) == 0 || mask.at(u + kApart, v) == 0) continue;
      const float* row = image.depth_mm.row(v);
      differences.push_back(std::abs(row[u - kApart] - 2.0f * row[u] + row[u + kApart]));
    }
  }
  if (differences.size() < 100) return 0.0;
  // The lower quartile: on parts whose surface bends the median would measure the bend.
  const auto quartile = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 4);
  std::nth_element(differences.begin(), quartile, differences.end());
  // |N(0, 6 sigma^2)| has its lower quartile at 0.3186 sqrt(6) sigma.
  return static_cast<double>(*quartile) / (0.3186 * std::sqrt(6.0));
}

}  // namespace rangepose
