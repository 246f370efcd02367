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
      surface, window, depth, [&](const SurfaceTexel& texel, double seen_mm, std::int32_t at) {
        if (std::abs(static_cast<double>(texel.w) - seen_mm) < same_mm) pixels.push_back(at);
      });
  return pixels;
}

JudgedPixels judgedPixels(const Image<SurfaceTexel>& surface,
                          const SurfaceWindow& window,
                          const DepthImage& depth,
                          const CheckOptions& options) {
  JudgedPixels pixels;
  forEachMeasured(
      surface, window, depth, [&](const SurfaceTexel& texel, double seen_mm, std::int32_t at) {
        switch (gapKind(texel, seen_mm, options)) {
          case GapKind::kAgrees:
            pixels.near.push_back({at, static_cast<float>(gapAlongNormal(texel, seen_mm))});
            break;
          case GapKind::kContradicted:
            pixels.near.push_back({at, kSeenThrough});
            break;
          case GapKind::kBuried:
            pixels.buried.push_back({at, texel.w});
            break;
          case GapKind::kHidden:
            break;
        }
      });
  return pixels;
}

// Fitted, as the weights of confidence.cpp, on pairs of a right and a wrong pose for one surface.
double Votes::logOdds() const {
  constexpr double kFew = 4.0;  // px that may err
  constexpr double kWeight = 2.0;
  return kWeight * std::log((first + kFew) / (second + kFew));
}

}  // namespace rangepose
