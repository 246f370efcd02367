#include "pipeline/explained_pixels.h"

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

}  // namespace rangepose
