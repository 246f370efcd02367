// How much better a part explains a surface than the smoothest surface that could lie there. Shared
// by host and CUDA.
#pragma once

#include <cmath>

#include "core/host_device.h"

namespace rangepose {

/// What an image shows where a pose agrees with it may be the part, or any other surface that is as
/// smooth: a floor, a rod, a ball. Of those the best is a quadric, z = a + bx + cy + dx^2 + exy +
/// fy^2 over the pixels. With errors from N(0, s^2), s fitted to each, the logarithm of how much
/// likelier a pixel is with the part there than with the quadric is log(s_quadric / s_part).
///
/// Sums over pixels. Nothing but doubles.
struct ReliefSums {
  static constexpr int kTerms = 6;
  double upper[21] = {};  ///< triangle of the normal matrix, row by row
  double right[kTerms] = {};
  double squared_mm2 = 0.0;      ///< of depths
  double own_squared_mm2 = 0.0;  ///< of what the data is off from the part
  double count = 0.0;

  /// `x` and `y`: of the pixel, -1..1 over the window; `depth_mm`: measured, from anywhere near;
  /// `off_mm`: of the data from the part along its normal; `slant`: cosine between normal and ray,
  /// by which an error of depth is smaller along the normal.
  RP_HD void add(double x, double y, double depth_mm, double off_mm, double slant) {
    const double weight = slant * slant;
    const double terms[kTerms] = {1.0, x, y, x * x, x * y, y * y};
    int k = 0;
    for (int i = 0; i < kTerms; ++i) {
      const double weighted = weight * terms[i];
      for (int j = i; j < kTerms; ++j) upper[k++] += weighted * terms[j];
      right[i] += weighted * depth_mm;
    }
    squared_mm2 += weight * depth_mm * depth_mm;
    own_squared_mm2 += off_mm * off_mm;
    count += 1.0;
  }
};

/// Sum of squares that the best quadric leaves [mm^2], by Cholesky factorisation. Terms that the
/// pixels do not determine, as along a line, are left out.
RP_HD double quadricResidual(const ReliefSums& sums) {
  constexpr int n = ReliefSums::kTerms;
  double a[n][n];
  double b[n];
  int k = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) a[j][i] = sums.upper[k++];
    b[i] = sums.right[i];
  }
  double left = sums.squared_mm2;
  for (int j = 0; j < n; ++j) {
    const double whole = a[j][j];
    for (int m = 0; m < j; ++m) a[j][j] -= a[j][m] * a[j][m];
    const bool known = a[j][j] > 1e-9 * whole + 1e-12;
    a[j][j] = known ? std::sqrt(a[j][j]) : 0.0;
    for (int i = j + 1; i < n; ++i) {
      for (int m = 0; m < j; ++m) a[i][j] -= a[i][m] * a[j][m];
      a[i][j] = known ? a[i][j] / a[j][j] : 0.0;
    }
    for (int m = 0; m < j; ++m) b[j] -= a[j][m] * b[m];
    b[j] = known ? b[j] / a[j][j] : 0.0;
    left -= b[j] * b[j];
  }
  return left > 0.0 ? left : 0.0;
}

/// Root mean square of what the data is off from the part [mm]; 0 without pixels.
RP_HD double ownDeviation(const ReliefSums& sums) {
  return sums.count > 0.0 ? std::sqrt(sums.own_squared_mm2 / sums.count) : 0.0;
}

/// log(s_quadric / s_part), -1..3; 0 where there are too few pixels to tell. Deviations below
/// `least_mm` [mm] are those of the arithmetic.
RP_HD double reliefOf(const ReliefSums& sums, double least_mm) {
  constexpr double kFewest = 20.0;
  constexpr double kLow = -1.0;
  constexpr double kHigh = 3.0;
  if (sums.count <= kFewest) return 0.0;
  const double own = ownDeviation(sums);
  const double other = std::sqrt(quadricResidual(sums) / sums.count);
  const double ratio =
      std::log((other > least_mm ? other : least_mm) / (own > least_mm ? own : least_mm));
  return ratio < kLow ? kLow : ratio > kHigh ? kHigh : ratio;
}

/// The relief of a surface that is seen whole, with errors of `own_mm` [mm], 0..3. Sums are of the
/// surface itself.
RP_HD double reliefOfWhole(const ReliefSums& sums, double own_mm, double least_mm) {
  constexpr double kHigh = 3.0;
  if (!(sums.count > 0.0)) return 0.0;
  const double own = own_mm > least_mm ? own_mm : least_mm;
  // What the quadric leaves of the surface adds to the errors.
  const double other = quadricResidual(sums) / sums.count;
  const double ratio = 0.5 * std::log(1.0 + other / (own * own));
  return ratio > kHigh ? kHigh : ratio;
}

}  // namespace rangepose
