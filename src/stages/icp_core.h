// One point of a projective ICP step and the solution of the step (paper Sect. 7; point-to-plane:
// Chen and Medioni 1992). Shared by host and CUDA.
#pragma once

#include "stages/device.h"

namespace rangepose {

/// Upper triangle of a symmetric 6x6 matrix, row by row, a right side, and the sums that say how
/// good the fit is.
struct IcpSums {
  double hessian[21];
  double gradient[6];
  double weight;      ///< sum of robust weights
  double squared_mm;  ///< weighted sum of squared residuals [mm^2]
};

/// Adds weight * row^T row and weight * residual * row.
RP_HD void addRow(IcpSums& sums, const double (&row)[6], double residual, double weight) {
  int k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) sums.hessian[k++] += weight * row[i] * row[j];
    sums.gradient[i] += weight * residual * row[i];
  }
}

/// Adds a model point with its scene point. Vectors are relative to the object's centre, in the
/// camera frame, in units of the object's radius, so that turns and shifts weigh alike.
///
/// The scene point is seen as the one that moves: the model's normal, which has no noise, is the
/// plane's. `slide` is the share of a point-to-point term: it holds what point-to-plane leaves
/// free, a model that reaches past the end of the data.
RP_HD void addPair(IcpSums& sums,
                   const double (&model)[3],
                   const double (&normal)[3],
                   const double (&scene)[3],
                   double weight,
                   double slide) {
  const double gap[3] = {scene[0] - model[0], scene[1] - model[1], scene[2] - model[2]};
  const double residual = normal[0] * gap[0] + normal[1] * gap[1] + normal[2] * gap[2];
  const double row[6] = {scene[1] * normal[2] - scene[2] * normal[1],
                         scene[2] * normal[0] - scene[0] * normal[2],
                         scene[0] * normal[1] - scene[1] * normal[0],
                         normal[0],
                         normal[1],
                         normal[2]};
  addRow(sums, row, residual, weight);
  sums.weight += weight;
  sums.squared_mm += weight * residual * residual;
  if (slide <= 0.0) return;
  const double row_x[6] = {0.0, scene[2], -scene[1], 1.0, 0.0, 0.0};
  const double row_y[6] = {-scene[2], 0.0, scene[0], 0.0, 1.0, 0.0};
  const double row_z[6] = {scene[1], -scene[0], 0.0, 0.0, 0.0, 1.0};
  addRow(sums, row_x, gap[0], weight * slide);
  addRow(sums, row_y, gap[1], weight * slide);
  addRow(sums, row_z, gap[2], weight * slide);
}

/// Solves (H + damping * I) x = g by Cholesky factorisation. False when H is not positive definite
/// even so.
RP_HD bool solveStep(const IcpSums& sums, double damping, double (&x)[6]) {
  double a[6][6];
  int k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      a[i][j] = sums.hessian[k];
      a[j][i] = sums.hessian[k++];
    }
    a[i][i] += damping;
    x[i] = sums.gradient[i];
  }
  for (int j = 0; j < 6; ++j) {
    for (int m = 0; m < j; ++m) a[j][j] -= a[j][m] * a[j][m] * a[m][m];
    if (!(a[j][j] > 0.0)) return false;
    for (int i = j + 1; i < 6; ++i) {
      for (int m = 0; m < j; ++m) a[i][j] -= a[i][m] * a[j][m] * a[m][m];
      a[i][j] /= a[j][j];
    }
  }
  for (int i = 0; i < 6; ++i) {
    for (int m = 0; m < i; ++m) x[i] -= a[i][m] * x[m];
  }
  for (int i = 0; i < 6; ++i) x[i] /= a[i][i];
  for (int i = 5; i >= 0; --i) {
    for (int m = i + 1; m < 6; ++m) x[i] -= a[m][i] * x[m];
  }
  return true;
}

}  // namespace rangepose
