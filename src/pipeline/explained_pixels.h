// The pixels of a depth image that a posed part accounts for.
#pragma once

#include <algorithm>
#include <cmath>
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
            seen,
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

/// A pixel of the depth image at which a posed part lies near the data or in front of it.
struct NearPixel {
  std::int32_t at;  ///< index, row by row
  float gap_mm;     ///< along the part's normal; kSeenThrough where the sensor saw through the part
};
inline constexpr float kSeenThrough = -1.0f;

/// A pixel of the depth image at which a posed part lies just behind nearer data.
struct BuriedPixel {
  std::int32_t at;  ///< index, row by row
  float depth_mm;   ///< of the part
};

/// Those of one part, by rising index.
struct JudgedPixels {
  std::vector<NearPixel> near;
  std::vector<BuriedPixel> buried;  ///< those that the check calls so
};

/// Those of a rendered surface. The window is one of the image, with step 1; the options are those
/// of the part's check.
JudgedPixels judgedPixels(const Image<SurfaceTexel>& surface,
                          const SurfaceWindow& window,
                          const DepthImage& depth,
                          const CheckOptions& options);

/// What pixels say about which of two poses of a part is right, where one of them must be.
struct Votes {
  double first = 0.0;   ///< for the first [px]
  double second = 0.0;  ///< for the second [px]

  /// Of the first. Neighbours err together, so that twice the votes are not twice as sure.
  double logOdds() const;
};

/// Each pixel where one of two poses comes `close_mm` near to the data, or nearly, and the other
/// does not has a vote, half of one where the other shows nothing: there the data may belong to
/// something else. So does each one where the sensor saw through one of them alone. Pixels of which
/// `counts(index)` is false have none.
template <typename Counts>
Votes votesBetween(const std::vector<NearPixel>& first,
                   const std::vector<NearPixel>& second,
                   double close_mm,
                   const Counts& counts) {
  constexpr double kOneAlone = 0.5;
  constexpr double kApart = 0.5;
  const auto closeness = [&](float gap_mm) {
    return gap_mm < 0.0f ? 0.0 : std::clamp(2.0 - static_cast<double>(gap_mm) / close_mm, 0.0, 1.0);
  };
  Votes votes;
  auto a = first.begin();
  auto b = second.begin();
  while (a != first.end() || b != second.end()) {
    const bool in_a = a != first.end() && (b == second.end() || a->at <= b->at);
    const bool in_b = b != second.end() && (a == first.end() || b->at <= a->at);
    const std::int32_t at = in_a ? a->at : b->at;
    const float gap_a = in_a ? (a++)->gap_mm : 0.0f;
    const float gap_b = in_b ? (b++)->gap_mm : 0.0f;
    // Most pixels: both are close.
    if (in_a && in_b && gap_a >= 0.0f && gap_b >= 0.0f && static_cast<double>(gap_a) <= close_mm &&
        static_cast<double>(gap_b) <= close_mm)
      continue;
    const bool through_a = gap_a == kSeenThrough;
    const bool through_b = gap_b == kSeenThrough;
    if (through_a || through_b) {
      if (through_a != through_b && counts(at)) (through_b ? votes.first : votes.second) += 1.0;
      continue;
    }
    const double more = (in_a ? closeness(gap_a) : 0.0) - (in_b ? closeness(gap_b) : 0.0);
    if (std::abs(more) <= kApart || !counts(at)) continue;
    (more > 0.0 ? votes.first : votes.second) += in_a && in_b ? 1.0 : kOneAlone;
  }
  return votes;
}

}  // namespace rangepose
