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
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const double model = static_cast<double>(surface.at(x, y).w);
      const double seen = static_cast<double>(depth.depth_mm.at(window.x0 + x, window.y0 + y));
      if (!(model > 0.0 && seen > 0.0 && std::abs(model - seen) < same_mm)) continue;
      pixels.push_back((window.y0 + y) * depth.camera.width + window.x0 + x);
    }
  }
  return pixels;
}

NearSurface::NearSurface(const Image<SurfaceTexel>& surface,
                         const SurfaceWindow& window,
                         const DepthImage& depth,
                         const CheckOptions& options)
    : bin_mm_(options.tolerance_mm / kBins) {
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfaceTexel& texel = surface.at(x, y);
      const double seen = static_cast<double>(depth.depth_mm.at(window.x0 + x, window.y0 + y));
      if (!(texel.w > 0.0f && seen > 0.0)) continue;
      const GapKind kind = gapKind(texel, seen, options);
      if (kind == GapKind::kHidden || kind == GapKind::kBuried) continue;
      const double width_mm = depth.camera.pixelSpacingMm(static_cast<double>(texel.w));
      const double mm2 = width_mm * width_mm;
      if (kind == GapKind::kContradicted) {
        seen_through_mm2_ += mm2;
        continue;
      }
      const int bin = static_cast<int>(gapAlongNormal(texel, seen) / bin_mm_);
      mm2_[static_cast<std::size_t>(std::min(bin, kBins - 1))] += mm2;
    }
  }
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
