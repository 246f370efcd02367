// The sums of a step of projective ICP and its solution (paper Sect. 7; point-to-plane: Chen and
// Medioni 1992). Shared by host and CUDA; what a point adds to the sums: icp_points_core.h.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "core/host_device.h"
#include "core/pose.h"
#include "stages/lanes.h"

namespace rangepose {

struct IcpOptions {
  int iterations = 10;
  double first_reach_mm =
      8.0;  ///< pairs farther apart than this are left out, in the first iteration [mm]
  double last_reach_mm = 2.0;  ///< in the last iteration [mm]; in between geometric
  int search_steps =
      2;               ///< partners are looked for on a grid of 2 * search_steps + 1 pixels a side
  double slide = 0.1;  ///< share of the point-to-point term
  double rim_reach_mm = 0.0;  ///< as far the end of the data may be from a rim [mm]; 0: no rims
  int rim_steps = 16;  ///< it is looked for in at most so many steps to each side, a pixel or more
                       ///< each
  /// Of a rim against a point of a face: it is known to a part of a pixel, a face to the noise.
  double rim_weight = 0.07;
  void check() const;  ///< throws Error naming the bad field
};

/// Upper triangle of a symmetric 6x6 matrix, row by row, a right side, and the sums that say how
/// good the fit is. Of one point or of eight at a time, added up in floats, which err by a
/// millionth.
template <typename Number>
struct IcpSumsOf {
  Number hessian[21];
  Number gradient[6];
  Number weight;   ///< sum of robust weights
  Number squared;  ///< weighted sum of squared residuals [radii^2]
};
/// Of all points, to be solved.
using IcpSums = IcpSumsOf<double>;

RP_HD IcpSums inDoubles(const IcpSumsOf<float>& sums) {
  IcpSums result;
  for (int i = 0; i < 21; ++i) result.hessian[i] = static_cast<double>(sums.hessian[i]);
  for (int i = 0; i < 6; ++i) result.gradient[i] = static_cast<double>(sums.gradient[i]);
  result.weight = static_cast<double>(sums.weight);
  result.squared = static_cast<double>(sums.squared);
  return result;
}

/// Adds weight * row^T row and weight * residual * row.
template <typename Number>
RP_LANES void addRow(IcpSumsOf<Number>& sums,
                     const Number (&row)[6],
                     const Number& residual,
                     const Number& weight) {
  int k = 0;
  for (int i = 0; i < 6; ++i) {
    const Number weighted = weight * row[i];
    for (int j = i; j < 6; ++j) sums.hessian[k++] += weighted * row[j];
    sums.gradient[i] += weighted * residual;
  }
}

/// Adds a model point with its scene point. Vectors are relative to the object's centre, in the
/// camera frame, in units of the object's radius, so that turns and shifts weigh alike.
///
/// The scene point is seen as the one that moves: the model's normal, which has no noise, is the
/// plane's. `slide` is the share of a point-to-point term: it holds what point-to-plane leaves
/// free, a model that reaches past the end of the data.
template <typename Number, typename Scalar>
RP_LANES void addPair(IcpSumsOf<Number>& sums,
                      const Lane3<Number>& model,
                      const Lane3<Number>& normal,
                      const Lane3<Number>& scene,
                      const Number& weight,
                      Scalar slide) {
  const Lane3<Number> gap = scene - model;
  const Number residual = dot(normal, gap);
  const Lane3<Number> turn = cross(scene, normal);
  addRow<Number>(sums, {turn.x, turn.y, turn.z, normal.x, normal.y, normal.z}, residual, weight);
  sums.weight += weight;
  sums.squared += weight * residual * residual;
  if (slide <= Scalar{}) return;
  // The rows of the three coordinates, (0, z, -y, 1, 0, 0), (-z, 0, x, 0, 1, 0) and (y, -x, 0, 0,
  // 0, 1), without their zeros.
  const Number w = weight * slide;
  const Number wx = w * scene.x;
  const Number wy = w * scene.y;
  const Number wz = w * scene.z;
  sums.hessian[0] += wz * scene.z + wy * scene.y;
  sums.hessian[1] -= wx * scene.y;
  sums.hessian[2] -= wx * scene.z;
  sums.hessian[4] -= wz;
  sums.hessian[5] += wy;
  sums.hessian[6] += wz * scene.z + wx * scene.x;
  sums.hessian[7] -= wy * scene.z;
  sums.hessian[8] += wz;
  sums.hessian[10] -= wx;
  sums.hessian[11] += wy * scene.y + wx * scene.x;
  sums.hessian[12] -= wy;
  sums.hessian[13] += wx;
  sums.hessian[15] += w;
  sums.hessian[18] += w;
  sums.hessian[20] += w;
  const Lane3<Number> pull = cross(scene, gap);
  sums.gradient[0] += w * pull.x;
  sums.gradient[1] += w * pull.y;
  sums.gradient[2] += w * pull.z;
  sums.gradient[3] += w * gap.x;
  sums.gradient[4] += w * gap.y;
  sums.gradient[5] += w * gap.z;
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

/// A pose to be moved, as it is before an iteration.
struct IcpFrame {
  Pose pose;             ///< camera_from_object
  glm::dvec3 center_mm;  ///< of the object's sphere, in the camera frame
  double radius_mm;      ///< of that sphere
  double reach_mm;       ///< pairs farther apart are left out
};

/// The first iteration's. `center_mm` is that of the object's sphere in the object's frame.
RP_HD IcpFrame firstFrame(const Pose& start,
                          const glm::dvec3& center_mm,
                          double radius_mm,
                          const IcpOptions& options) {
  return {start, start * center_mm, radius_mm, options.first_reach_mm};
}

/// Pairs below which a step says nothing.
inline constexpr int kFewestPairs = 6;

/// Root mean square of the point-to-plane residuals [mm].
RP_HD double icpRms(const IcpSums& sums, double radius_mm) {
  const double weight = sums.weight < 1e-9 ? 1e-9 : sums.weight;
  return radius_mm * std::sqrt(sums.squared / weight);
}

/// Moves the pose by the solution of the sums; false (and nothing moved) when there is none.
/// `center_mm` is that of the object's sphere in the object's frame.
RP_HD bool icpMove(Pose& pose,
                   const IcpSums& sums,
                   const IcpFrame& frame,
                   const glm::dvec3& center_mm) {
  double step[6];
  if (!solveStep(sums, 1e-4 * sums.weight, step)) return false;
  const glm::dmat3 turn = rotationFromVector({step[0], step[1], step[2]});
  const glm::dvec3 moved =
      frame.center_mm + frame.radius_mm * glm::dvec3(step[3], step[4], step[5]);
  pose.rotation = orthonormalized(turn * pose.rotation);
  pose.translation_mm = moved - pose.rotation * center_mm;
  return true;
}

struct IcpResult {
  Pose camera_from_object;
  double rms_mm = 0.0;  ///< weighted root mean square of the point-to-plane residuals [mm]
  double paired = 0.0;  ///< share of the points that found a partner, 0..1
  int iterations = 0;
};

/// Ends an iteration in which `pairs` of `points` had partners. False when it was the last one that
/// can move the pose. `center_mm` as in icpMove.
RP_HD bool icpAdvance(IcpResult& result,
                      IcpFrame& frame,
                      const IcpSums& sums,
                      double pairs,
                      int points,
                      const glm::dvec3& center_mm,
                      double shrink) {
  ++result.iterations;
  result.paired = points > 0 ? pairs / static_cast<double>(points) : 0.0;
  if (pairs < kFewestPairs) return false;
  result.rms_mm = icpRms(sums, frame.radius_mm);
  if (!icpMove(result.camera_from_object, sums, frame, center_mm)) return false;
  frame.pose = result.camera_from_object;
  frame.center_mm = frame.pose * center_mm;
  frame.reach_mm *= shrink;
  return true;
}

}  // namespace rangepose
