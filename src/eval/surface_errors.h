// What a sensor's depth is off on surfaces whose poses are known: noise from pixel to pixel, and
// the error that many pixels have in common.
//
// The error e of a pixel is measured minus known depth, along z. Poses are only known to within
// some shift, more so those that were fitted to the data: the small rigid motion of the part that
// explains most of e (point-to-plane least squares) is taken out, on true poses, too, so that all
// are treated alike. Where a part has few patches of common error, it takes some of that, too.
#pragma once

#include <array>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "eval/known_surface.h"

namespace rangepose {

/// Distances [px] at which the errors of two pixels are compared.
inline constexpr std::array<int, 9> kErrorShiftsPx = {1, 2, 3, 5, 7, 10, 15, 20, 30};

/// Pixels seen more obliquely than this are left out: there e is what the pose is off sideways.
inline constexpr double kLeastErrorCosine = 0.5;

/// e without the motion [mm] at the inner pixels of counted parts that agree with the data; NaN
/// elsewhere, and on parts with too few of them to fit a motion.
Image<float> surfaceErrors(const DepthImage& image,
                           const KnownSurface& known,
                           const std::vector<KnownPart>& parts);

/// Sums over pairs of pixels on the same part, so far from each other along a row or a column.
struct ErrorPairs {
  double half_squares = 0.0;  ///< of 0.5 (a - b)^2 [mm^2]
  double mean_squares = 0.0;  ///< of 0.5 (a^2 + b^2) [mm^2]
  long long count = 0;
};

/// What images are added up to; equal for any order of threads as images are added in their own.
struct SurfaceErrorTally {
  std::vector<float> second_mm;  ///< sizes of e(u-1) - 2 e(u) + e(u+1) along rows and columns
  double squares = 0.0;          ///< of e [mm^2]
  double sizes = 0.0;            ///< of e [mm]
  long long pixels = 0;
  double deep_squares = 0.0;  ///< of e where it is kDeepPx or more inside [mm^2]
  long long deep_pixels = 0;
  std::array<ErrorPairs, kErrorShiftsPx.size()> pairs;

  void add(const SurfaceErrorTally& other);
};

SurfaceErrorTally tallySurfaceErrors(const Image<float>& errors_mm, const KnownSurface& known);

/// Deviation of the noise from sizes of second differences [mm]: their rms, cut off at three
/// deviations round by round, over sqrt(6). Unlike a median it does not fall to zero where depth
/// comes in steps. NaN without one.
double noiseBetweenNeighbours(std::vector<float> second_mm);

}  // namespace rangepose
