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

std::vector<NearPixel> nearPixels(const Image<SurfaceTexel>& surface,
                                  const SurfaceWindow& window,
                                  const DepthImage& depth,
                                  const CheckOptions& options) {
  std::vector<NearPixel> pixels;
  forEachMeasured(
      surface, window, depth, [&](const SurfaceTexel& texel, double seen_mm, std::int32_t at) {
        const GapKind kind = gapKind(texel, seen_mm, options);
        if (kind == GapKind::kHidden || kind == GapKind::kBuried) return;
        const bool through = kind == GapKind::kContradicted;
        pixels.push_back(
            {at, through ? kSeenThrough : static_cast<float>(gapAlongNormal(texel, seen_mm))});
      });
  return pixels;
}

// Fitted, as the weights of confidence.cpp, on pairs of a right and a wrong pose for one surface.
double Votes::logOdds() const {
  constexpr double kFew = 4.0;  // px that may err
  return 2.5 * std::log((first + kFew) / (second + kFew));
}

}  // namespace rangepose
