// One point of a projective ICP step and the solution of the step (paper Sect. 7; point-to-plane:
// Chen and Medioni 1992). Shared by host and CUDA.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/camera.h"
#include "core/pose.h"
#include "stages/device.h"
#include "stages/surface_points.h"

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
  /// Of a rim against a point of a face: it is known to a part of a pixel, a face to the noise.
  double rim_weight = 0.07;
  void check() const;  ///< throws Error naming the bad field
};

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
  // The rows of the three coordinates, (0, z, -y, 1, 0, 0), (-z, 0, x, 0, 1, 0) and (y, -x, 0, 0,
  // 0, 1), without their zeros.
  const double w = weight * slide;
  const double x = scene[0];
  const double y = scene[1];
  const double z = scene[2];
  sums.hessian[0] += w * z * z;
  sums.hessian[0] += w * y * y;
  sums.hessian[1] -= w * x * y;
  sums.hessian[2] -= w * x * z;
  sums.hessian[4] -= w * z;
  sums.hessian[5] += w * y;
  sums.hessian[6] += w * z * z;
  sums.hessian[6] += w * x * x;
  sums.hessian[7] -= w * y * z;
  sums.hessian[8] += w * z;
  sums.hessian[10] -= w * x;
  sums.hessian[11] += w * y * y;
  sums.hessian[11] += w * x * x;
  sums.hessian[12] -= w * y;
  sums.hessian[13] += w * x;
  sums.hessian[15] += w;
  sums.hessian[18] += w;
  sums.hessian[20] += w;
  sums.gradient[0] += w * (y * gap[2] - z * gap[1]);
  sums.gradient[1] += w * (z * gap[0] - x * gap[2]);
  sums.gradient[2] += w * (x * gap[1] - y * gap[0]);
  for (int i = 0; i < 3; ++i) sums.gradient[3 + i] += w * gap[i];
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

/// A depth image as the association reads it: `read(u, v)` gives the depth [mm] of a pixel inside
/// of it, 0 where nothing was measured.
template <typename Read>
struct DepthReader {
  const Camera& camera;
  int width;   ///< [px]
  int height;  ///< [px]
  const Read& read;

  RP_HD bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
};

struct IcpPartner {
  bool found;
  glm::dvec3 point_mm;  ///< in the camera frame
};

/// The nearest measured point to `point_mm` on a grid of 2 * steps + 1 pixels a side, whose spacing
/// follows from `reach_mm`; none if the point is hidden or has no partner within the reach.
template <typename Read>
RP_HD IcpPartner
icpPartner(const DepthReader<Read>& scene, const glm::dvec3& point_mm, double reach_mm, int steps) {
  IcpPartner nearest{false, glm::dvec3(0.0)};
  if (!scene.camera.orthographic && point_mm.z <= 1.0) return nearest;
  const glm::dvec2 pixel = scene.camera.project(point_mm);
  const double u_real = std::floor(pixel.x + 0.5);
  const double v_real = std::floor(pixel.y + 0.5);
  // Not "outside", so that a NaN counts as outside too.
  if (!(u_real >= 0.0 && v_real >= 0.0 && u_real < scene.width && v_real < scene.height)) {
    return nearest;
  }
  const int u = static_cast<int>(u_real);
  const int v = static_cast<int>(v_real);
  const double here = scene.read(u, v);
  if (here != 0.0 && here < point_mm.z - reach_mm) return nearest;
  const double pixel_mm = scene.camera.pixelSpacingMm(point_mm.z);
  const int share = static_cast<int>(reach_mm / pixel_mm / steps);
  const int spacing = share < 1 ? 1 : share;
  double best = reach_mm * reach_mm;
  const auto consider = [&](int x, int y) {
    const double depth = scene.read(x, y);
    if (depth == 0.0) return;
    // No nearer than along z alone.
    const double behind = depth - point_mm.z;
    if (!(behind * behind < best)) return;
    const glm::dvec3 candidate = scene.camera.unproject(x, y, depth);
    const glm::dvec3 gap = candidate - point_mm;
    const double squared = glm::dot(gap, gap);
    if (squared < best) {
      best = squared;
      nearest = {true, candidate};
    }
  };
  consider(u, v);
  // The point lies at most half a pixel from its own: no other comes nearer than this, but for the
  // slant of the rays.
  const double others_mm = (spacing - 0.5) * pixel_mm;
  if (best <= others_mm * others_mm) return nearest;
  for (int dv = -steps; dv <= steps; ++dv) {
    for (int du = -steps; du <= steps; ++du) {
      const int x = u + du * spacing;
      const int y = v + dv * spacing;
      if ((du != 0 || dv != 0) && scene.contains(x, y)) consider(x, y);
    }
  }
  return nearest;
}

/// What all points of an iteration share.
struct IcpFrame {
  Pose pose;             ///< camera_from_object, as it is before the iteration
  glm::dvec3 center_mm;  ///< of the object's sphere, in the camera frame
  double radius_mm;      ///< of that sphere
  double reach_mm;       ///< pairs farther apart are left out
  int search_steps;
  double slide;         ///< share of the point-to-point term
  double rim_reach_mm;  ///< see IcpOptions
  double rim_weight;
  double rim_gap_mm;  ///< data so far behind the rim's surface belongs to something else
};

/// The first iteration's. `center_mm` is that of the object's sphere in the object's frame.
RP_HD IcpFrame firstFrame(const Pose& start,
                          const glm::dvec3& center_mm,
                          double radius_mm,
                          const IcpOptions& options) {
  return {start,
          start * center_mm,
          radius_mm,
          options.first_reach_mm,
          options.search_steps,
          options.slide,
          options.rim_reach_mm,
          options.rim_weight,
          options.last_reach_mm};
}

struct RimPartner {
  bool found;
  double beyond_mm;  ///< as far the data goes on beyond the rim; negative where it ends before
};

/// Where the data ends nearest to a rim on the line `out` (unit, the tangent) across it. The data
/// is followed from inside to outside, in the slope of `out`, from where it is first
/// within the frame's reach of the line: a pose that is off in depth or slope meets the same end.
/// What lies behind it or was not measured, twice in a row, ends it. Nearer data hides where it
/// ends.
template <typename Read>
RP_HD RimPartner rimPartner(const DepthReader<Read>& scene,
                            const glm::dvec3& point_mm,
                            const glm::dvec3& out,
                            const IcpFrame& frame) {
  constexpr int kEnded = 2;
  RimPartner nearest{false, frame.rim_reach_mm};
  if (!scene.camera.orthographic && point_mm.z <= 1.0) return nearest;
  const double step_mm = scene.camera.pixelSpacingMm(point_mm.z);
  const double across = std::sqrt(out.x * out.x + out.y * out.y);
  if (!(across > 0.1)) return nearest;
  // A pixel a step. Over so short a way the line's image is taken as evenly spaced.
  const glm::dvec3 step = out * (step_mm / across);
  const glm::dvec2 pixel = scene.camera.project(point_mm);
  const glm::dvec2 pixel_step = scene.camera.project(point_mm + step) - pixel;
  const int steps = static_cast<int>(std::ceil(frame.rim_reach_mm / step_mm)) + 1;
  const double u_margin = (steps + 1) * std::fabs(pixel_step.x) + 0.5;
  const double v_margin = (steps + 1) * std::fabs(pixel_step.y) + 0.5;
  // Not "outside", so that a NaN counts as outside too.
  if (!(pixel.x > u_margin && pixel.x < scene.width - 1 - u_margin && pixel.y > v_margin &&
        pixel.y < scene.height - 1 - v_margin)) {
    return nearest;
  }
  // Pixels as whole numbers of their 65536ths, rounded to the nearest one when shifted.
  constexpr int kPixelBits = 16;
  constexpr double kPixel = 1 << kPixelBits;
  const auto du = static_cast<std::int64_t>(kPixel * pixel_step.x);
  const auto dv = static_cast<std::int64_t>(kPixel * pixel_step.y);
  std::int64_t u = static_cast<std::int64_t>(kPixel * (pixel.x + 0.5)) - steps * du;
  std::int64_t v = static_cast<std::int64_t>(kPixel * (pixel.y + 0.5)) - steps * dv;
  const float reach_mm = static_cast<float>(frame.reach_mm);
  const float gap_mm = static_cast<float>(frame.rim_gap_mm);
  float line_mm = static_cast<float>(point_mm.z - steps * step.z);
  float shift_mm = 0.0f;  // of the data from the line
  bool followed = false;
  int last_on = 0;
  int off = kEnded;  // nothing has begun that could end
  for (int i = -steps; i <= steps + 1; ++i) {
    const float seen =
        scene.read(static_cast<int>(u >> kPixelBits), static_cast<int>(v >> kPixelBits));
    const float behind_line = seen - line_mm;
    u += du;
    v += dv;
    line_mm += static_cast<float>(step.z);
    if (!followed && seen != 0.0f && std::fabs(behind_line) < reach_mm) {
      followed = true;
      shift_mm = behind_line;
    }
    const float behind = behind_line - shift_mm;
    if (seen != 0.0f && behind < -gap_mm) {
      off = kEnded;
    } else if (seen != 0.0f && behind < gap_mm) {
      last_on = i;
      off = 0;
      shift_mm = behind_line;
    } else if (++off == kEnded) {
      const double beyond_mm = (last_on + 0.5) * step_mm;
      if (std::fabs(beyond_mm) < std::fabs(nearest.beyond_mm)) nearest = {true, beyond_mm};
    }
    // Another end would lie farther out than here.
    if (nearest.found && i * step_mm > std::fabs(nearest.beyond_mm)) return nearest;
  }
  return nearest;
}

/// Adds a point of the rim, given in the camera frame, with its partner; false if it has none. Its
/// row says how far the rim moves across itself in the image, which motion along the line of sight
/// does not change. Without weight in the sums that tell how well faces fit.
template <typename Read>
RP_HD bool addRim(IcpSums& sums,
                  const IcpFrame& frame,
                  const DepthReader<Read>& scene,
                  const glm::dvec3& point_mm,
                  const glm::dvec3& out) {
  const RimPartner partner = rimPartner(scene, point_mm, out, frame);
  if (!partner.found) return false;
  const double across = std::sqrt(out.x * out.x + out.y * out.y);
  glm::dvec3 n(out.x / across, out.y / across, 0.0);
  if (!scene.camera.orthographic) n.z = -(n.x * point_mm.x + n.y * point_mm.y) / point_mm.z;
  const double residual = partner.beyond_mm * glm::dot(n, out) / (across * frame.radius_mm);
  const glm::dvec3 m = (point_mm - frame.center_mm) / frame.radius_mm;
  const glm::dvec3 turn = glm::cross(m, n);
  const double ratio = partner.beyond_mm / frame.rim_reach_mm;
  const double rest = 1.0 - ratio * ratio;
  addRow(sums, {turn.x, turn.y, turn.z, n.x, n.y, n.z}, residual, frame.rim_weight * rest * rest);
  return true;
}

/// Adds a point of the object with its partner; false if it has none. The weight is Tukey's over
/// the reach.
template <typename Read>
RP_HD bool addPoint(IcpSums& sums,
                    const IcpFrame& frame,
                    const DepthReader<Read>& scene,
                    const SurfacePoint& own) {
  const glm::dvec3 point = frame.pose * glm::dvec3(own.position_mm);
  const glm::dvec3 n = frame.pose.rotation * glm::dvec3(own.normal);
  if (own.rim) {
    return frame.rim_reach_mm > 0.0 && addRim(sums, frame, scene, point, n);
  }
  const IcpPartner partner = icpPartner(scene, point, frame.reach_mm, frame.search_steps);
  if (!partner.found) return false;
  const glm::dvec3 gap = partner.point_mm - point;
  const glm::dvec3 m = (point - frame.center_mm) / frame.radius_mm;
  const glm::dvec3 s = (partner.point_mm - frame.center_mm) / frame.radius_mm;
  const double rest = 1.0 - glm::dot(gap, gap) / (frame.reach_mm * frame.reach_mm);
  const double weight = rest > 0.0 ? rest * rest : 0.0;
  addPair(sums, {m.x, m.y, m.z}, {n.x, n.y, n.z}, {s.x, s.y, s.z}, weight, frame.slide);
  return true;
}

/// Pairs below which a step says nothing.
inline constexpr int kFewestPairs = 6;

/// Root mean square of the point-to-plane residuals [mm].
RP_HD double icpRms(const IcpSums& sums, double radius_mm) {
  const double weight = sums.weight < 1e-9 ? 1e-9 : sums.weight;
  return radius_mm * std::sqrt(sums.squared_mm / weight);
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

}  // namespace rangepose
