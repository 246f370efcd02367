// The pixels of a depth image that a posed part accounts for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "stages/check_core.h"
#include "stages/surface.h"

namespace rangepose {

/// Calls `pixel(texel, seen_mm, index)` for each pixel of a rendered surface that was measured, row
/// by row; the index is that of the depth image. The window is one of the image, with step 1.
template <typename Pixel>
void forEachMeasured(const Image<SurfaceTexel>& surface,
                     const SurfaceWindow& window,
                     const DepthImage& depth,
                     const Pixel& pixel) {
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfaceTexel& texel = surface.at(x, y);
      const float seen = depth.depth_mm.at(window.x0 + x, window.y0 + y);
      if (!(texel.w > 0.0f && seen > 0.0f)) continue;
      pixel(texel,
            static_cast<double>(seen),
            static_cast<std::int32_t>((window.y0 + y) * depth.camera.width + window.x0 + x));
    }
  }
}

/// Surfaces of a part and of the data closer than this [mm] are the same, where `tolerance_mm` is
/// that of the part's check: twice, for what a pose is off leaves no rim of a found part to others.
double sameSurfaceMm(double tolerance_mm);

/// Indices into the depth image (row by row) of the measured pixels within `same_mm` of the
/// rendered surface. The window is one of the image, with step 1.
std::vector<std::int32_t> explainedPixels(const Image<SurfaceTexel>& surface,
                                          const SurfaceWindow& window,
                                          const DepthImage& depth,
                                          double same_mm);

/// The surface of a posed part that lies near the data, by how near.
class NearSurface {
 public:
  NearSurface() = default;
  /// The window is one of the image, with step 1; the options are those of the part's check.
  NearSurface(const Image<SurfaceTexel>& surface,
              const SurfaceWindow& window,
              const DepthImage& depth,
              const CheckOptions& options);
  /// What agrees with the data to within `close_mm`, and less and less of what is up to twice as
  /// far from it, minus what the sensor saw through [mm^2].
  double explainedMm2(double close_mm) const;

 private:
  static constexpr int kBins = 64;
  double bin_mm_ = 0.0;              ///< width of a bin; the last ends at the tolerance
  double seen_through_mm2_ = 0.0;    ///< as the camera sees it, as the bins
  std::array<double, kBins> mm2_{};  ///< by distance along the model's normal
};

}  // namespace rangepose
