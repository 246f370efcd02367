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

NearSurface::NearSurface(const Image<SurfaceTexel>& surface,
                         const SurfaceWindow& window,
                         const DepthImage& depth,
                         const CheckOptions& options)
    : bin_mm_(options.tolerance_mm / kBins) {
  forEachMeasured(surface, window, depth, [&](const SurfaceTexel& texel, double seen_mm, auto) {
    const GapKind kind = gapKind(texel, seen_mm, options);
    if (kind == GapKind::kHidden || kind == GapKind::kBuried) return;
    const double width_mm = depth.camera.pixelSpacingMm(static_cast<double>(texel.w));
    const double mm2 = width_mm * width_mm;
    if (kind == GapKind::kContradicted) {
      seen_through_mm2_ += mm2;
      return;
    }
    const int bin = static_cast<int>(gapAlongNormal(texel, seen_mm) / bin_mm_);
    mm2_[static_cast<std::size_t>(std::min(bin, kBins - 1))] += mm2;
  });
}

double NearSurface::explainedMm2(double close_mm) const {
  double sum_mm2 = -seen_through_mm2_;
  for (int i = 0; i < kBins; ++i) {
    const double middle_mm = (i + 0.5) * bin_mm_;
    sum_mm2 += std::clamp(2.0 - middle_mm / close_mm, 0.0, 1.0) * mm2_[static_cast<std::size_t>(i)];
  }
  return sum_mm2;
}

}  // namespace rangepose
