#include "pipeline/explained_pixels.h"

#include <algorithm>
#include <cmath>

namespace rangepose {

double sameSurfaceMm(double tolerance_mm) { return 2.0 * tolerance_mm; }

std::vector<std::int32_t> explainedPixels(const Image<SurfaceTexel>& surface,
                                          const SurfaceWindow& window,
                                          const DepthImage& depth,
                                          double same_mm) {
  std::vector<std::int32_t> pixels;
  forEachMeasured(
      surface, window, depth, [&](const SurfaceTexel& texel, float seen_mm, std::int32_t at) {
        if (static_cast<double>(std::abs(texel.w - seen_mm)) < same_mm) pixels.push_back(at);
      });
  return pixels;
}

JudgedPixels judgedPixels(const Image<SurfaceTexel>& surface,
                          const SurfaceWindow& window,
                          const DepthImage& depth,
                          const CheckOptions& options) {
  const GapLimits limits = gapLimits(options);
  JudgedPixels pixels;
  forEachMeasured(
      surface, window, depth, [&](const SurfaceTexel& texel, float seen_mm, std::int32_t at) {
        const GapOf<float> gap = gapOf(limits, true, texel.z, texel.w, seen_mm);
        if (gap.agrees) pixels.near.push_back({at, gap.distance_mm});
        if (gap.contradicted) pixels.near.push_back({at, kSeenThrough});
        if (gap.buried) pixels.buried.push_back({at, texel.w});
      });
  return pixels;
}

// The weight is fitted, as those of confidence.cpp, on pairs of a right and a wrong pose for one
// surface; how many pixels may err was chosen on bins of parts that have twins.
double Votes::logOdds() const {
  constexpr double kFew = 2.0;  // px that may err
  constexpr double kWeight = 2.0;
  return kWeight * std::log((first + kFew) / (second + kFew));
}

}  // namespace rangepose
