#include "stages/dropouts_host.h"

#include <algorithm>

#include "stages/dropouts_core.h"

namespace rangepose::host {

DepthImage fillDropouts(const DepthImage& image, double noise_mm) {
  const Image<float>& seen = image.depth_mm;
  const auto read = [&](int u, int v) { return seen.at(u, v); };
  DepthImage filled = image;
  int lost = 0;
  for (int v = 1; v + 1 < seen.height(); ++v) {
    for (int u = 1; u + 1 < seen.width(); ++u) {
      if (seen.at(u, v) != 0.0f) continue;
      const float depth_mm = filledDropout(image.camera, read, u, v, noise_mm);
      if (depth_mm == 0.0f) continue;
      filled.depth_mm.at(u, v) = depth_mm;
      ++lost;
    }
  }
  const auto all = std::count_if(seen.begin(), seen.end(), [](float mm) { return mm > 0.0f; });
  if (!areMany(lost, static_cast<int>(all))) return image;
  return filled;
}

}  // namespace rangepose::host
