// The verdict on a pose, pixel by pixel: shared by host and CUDA.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "geometry/stability.h"
#include "stages/device.h"
#include "stages/surface.h"
#include "stages/surface_points.h"

namespace rangepose {

struct CheckOptions {
  double tolerance_mm = 2.0;     ///< surfaces this close are the same [mm]
  double max_tilt_rad = 0.6;     ///< normals of the same surface differ by at most this [rad]
  double contradicted = 2.0;     ///< weight of surface in front of the data in the score
  double missing = 0.5;          ///< weight of surface where nothing was measured
  double hidden = 0.3;           ///< weight of surface well behind nearer data
  double buried = 1.5;           ///< weight of surface just behind nearer data
  double buried_tolerances = 4;  ///< "just behind": by at most this many tolerances
  double weak = 1.0;             ///< weight of the part of an agreeing pixel that does not agree
  double border = 0.9;           ///< share of the score that depends on the outline
};

/// Shares of the model's visible surface (of its rendered pixels); the first six add up to 1.
struct CheckResult {
  double explained = 0.0;        ///< agrees with the data in depth and slope
  double contradicted = 0.0;     ///< in front of the data: the sensor saw through it
  double hidden = 0.0;           ///< well behind nearer data: something lies on it
  double buried = 0.0;           ///< just behind nearer data: the data's surface is not the model's
  double missing = 0.0;          ///< no measurement there
  double weak = 0.0;             ///< near the data, but less than explained
  double outline = 0.0;          ///< share of the outline where the data ends with the model, 0..1
  double outline_covered = 0.0;  ///< share of the outline of which nothing can be said: covered, or
                                 ///< no measurement; counts half
  double flat = 0.0;             ///< length of the mean normal of what is near the data, 0..1: 1
                                 ///< where that is one flat face
  double jumps_met = 0.0;     ///< share of the jumps of depth inside of the outline that are in the
                              ///< data as well, 0..1; 0.5 without any
  double jumps_missed = 0.0;  ///< jumps in place of which the data is level [root of the pixels]
  /// Of what agrees, and of the outline where it was seen to end, in the camera frame.
  StabilityCovariance covariance;
  double stability = 0.0;      ///< see stability(): of that, 0..1; set by the pipeline
  double residual_mm = 0.0;    ///< mean absolute depth difference of the explained surface [mm]
  double explained_mm2 = 0.0;  ///< explained surface as the camera sees it [mm^2]
  int pixels = 0;              ///< rendered pixels
  double score = 0.0;          ///< 0..1, higher is better
};

/// Reads the measured surface at camera pixels: `read(u, v)` gives the depth [mm] of a pixel inside
/// of the image, 0 where nothing was measured.
template <typename Read>
struct Measured {
  const Camera& camera;
  double tolerance_mm;
  const Read& read;

  struct Vector {
    bool known;
    glm::dvec3 value;
  };

  RP_HD bool inImage(int u, int v) const {
    return u >= 0 && v >= 0 && u < camera.width && v < camera.height;
  }
  RP_HD double at(int u, int v) const {
    return inImage(u, v) ? static_cast<double>(read(u, v)) : 0.0;
  }

  /// Normal towards the camera from the points `reach` pixels away; unknown where the surface ends.
  RP_HD Vector normal(int u, int v, int reach) const {
    const Vector across = slope(u, v, reach, 0);
    const Vector down = slope(u, v, 0, reach);
    if (!across.known || !down.known) return {false, glm::dvec3(0.0)};
    return {true, glm::normalize(glm::cross(down.value, across.value))};
  }

  /// Sine of the angle between a plane and the way from one measured point to another; 1 where the
  /// other was not measured.
  RP_HD double riseAlong(const glm::dvec3& normal, int u, int v, int to_u, int to_v) const {
    const double there = at(to_u, to_v);
    if (there == 0.0) return 1.0;
    const glm::dvec3 way = camera.unproject(to_u, to_v, there) - camera.unproject(u, v, at(u, v));
    return std::abs(glm::dot(normal, way)) / glm::length(way);
  }

  RP_HD Vector slope(int u, int v, int du, int dv) const {
    const double before = at(u - du, v - dv);
    const double here = at(u, v);
    const double after = at(u + du, v + dv);
    // Where the surface bends by more than the tolerance it is not one surface.
    const bool one = before != 0.0 && after != 0.0 &&
                     !(std::abs(before + after - 2.0 * here) > 4.0 * tolerance_mm);
    if (!one) return {false, glm::dvec3(0.0)};
    return {true,
            camera.unproject(u + du, v + dv, after) - camera.unproject(u - du, v - dv, before)};
  }
};

/// Sums over the pixels of a model. Nothing but doubles, so that a block of threads can add them up
/// like an array.
struct CheckTally {
  double explained = 0.0;
  double contradicted = 0.0;
  double hidden = 0.0;
  double buried = 0.0;
  double missing = 0.0;
  double weak = 0.0;
  double residual_mm = 0.0;
  double agreeing = 0.0;
  double normal_x = 0.0;
  double normal_y = 0.0;
  double normal_z = 0.0;
  double pixels = 0.0;
  double border = 0.0;
  double border_ends = 0.0;
  double border_covered = 0.0;
  double visible_mm2 = 0.0;
};

/// Options, and what follows from them for all pixels.
struct CheckRules {
  CheckOptions options;
  double least_cosine;  ///< of normals of the same surface
  int normal_reach;     ///< the data's slope is taken between points that far away [px]
};

/// `normal_reach` of points, which have no window that they were rendered with [px].
inline constexpr int kPointNormalReach = 2;

RP_HD CheckRules checkRules(const CheckOptions& options, int normal_reach) {
  return {options, std::cos(options.max_tilt_rad), normal_reach};
}

/// Where a model's surface lies from the data.
enum class GapKind : int { kAgrees, kContradicted, kBuried, kHidden };

/// Depth difference along the model's normal: on a slope it is smaller than along the ray.
RP_HD double gapAlongNormal(const SurfaceTexel& model, double seen_mm) {
  const double slant = static_cast<double>(std::abs(model.z));
  return std::abs(seen_mm - static_cast<double>(model.w)) * (slant > 0.3 ? slant : 0.3);
}

RP_HD GapKind gapKind(const SurfaceTexel& model, double seen_mm, const CheckOptions& options) {
  const double distance = gapAlongNormal(model, seen_mm);
  if (distance <= options.tolerance_mm) return GapKind::kAgrees;
  if (seen_mm > static_cast<double>(model.w)) return GapKind::kContradicted;
  const bool just = distance <= options.buried_tolerances * options.tolerance_mm;
  return just ? GapKind::kBuried : GapKind::kHidden;
}

/// `model` against the data at camera pixel (u, v).
template <typename Read>
RP_HD void judgePixel(const SurfaceTexel& model,
                      const Measured<Read>& measured,
                      int u,
                      int v,
                      const CheckRules& rules,
                      CheckTally& tally) {
  const CheckOptions& options = rules.options;
  tally.pixels += 1.0;
  const double seen = measured.at(u, v);
  if (seen == 0.0) {
    tally.missing += 1.0;
    return;
  }
  const GapKind kind = gapKind(model, seen, options);
  if (kind != GapKind::kAgrees) {
    (kind == GapKind::kContradicted ? tally.contradicted
     : kind == GapKind::kBuried     ? tally.buried
                                    : tally.hidden) += 1.0;
    return;
  }
  const double distance = gapAlongNormal(model, seen);
  const double ratio = distance / options.tolerance_mm;
  double agreement = 1.0 - 0.5 * ratio * ratio;
  const typename Measured<Read>::Vector normal = measured.normal(u, v, rules.normal_reach);
  if (normal.known && glm::dot(normal.value, glm::dvec3(model)) < rules.least_cosine) {
    agreement *= 0.3;
  }
  tally.explained += agreement;
  tally.weak += 1.0 - agreement;
  tally.residual_mm += distance;
  tally.agreeing += 1.0;
  tally.normal_x += static_cast<double>(model.x);
  tally.normal_y += static_cast<double>(model.y);
  tally.normal_z += static_cast<double>(model.z);
}

/// One point of an object at a pose; those of a rim have no say.
template <typename Read>
RP_HD void judgePoint(const SurfacePoint& own,
                      const Pose& camera_from_object,
                      const Measured<Read>& measured,
                      const CheckRules& rules,
                      CheckTally& tally) {
  if (own.rim) return;
  const Camera& camera = measured.camera;
  const glm::dvec3 point = camera_from_object * glm::dvec3(own.position_mm);
  if (!camera.orthographic && point.z <= 1.0) return;
  const glm::dvec2 projected = camera.project(point);
  const double u = std::floor(projected.x + 0.5);
  const double v = std::floor(projected.y + 0.5);
  // Not "outside", so that a NaN counts as outside too.
  if (!(u >= 0.0 && v >= 0.0 && u < camera.width && v < camera.height)) {
    tally.pixels += 1.0;
    tally.missing += 1.0;
    return;
  }
  const glm::vec3 normal(camera_from_object.rotation * glm::dvec3(own.normal));
  judgePixel(SurfaceTexel(normal, static_cast<float>(point.z)),
             measured,
             static_cast<int>(u),
             static_cast<int>(v),
             rules,
             tally);
}

/// Shares and score; `outline_factor` is what the outline leaves of the score.
RP_HD CheckResult summarizeCheck(const CheckTally& tally,
                                 const CheckOptions& options,
                                 double outline_factor,
                                 double visible_mm2) {
  CheckResult result;
  result.pixels = static_cast<int>(tally.pixels);
  if (result.pixels == 0) return result;
  const double all = tally.pixels;
  result.explained = tally.explained / all;
  result.contradicted = tally.contradicted / all;
  result.hidden = tally.hidden / all;
  result.buried = tally.buried / all;
  result.missing = tally.missing / all;
  result.weak = tally.weak / all;
  result.explained_mm2 = result.explained * visible_mm2;
  const glm::dvec3 normal(tally.normal_x, tally.normal_y, tally.normal_z);
  result.flat = tally.agreeing > 0.0 ? glm::length(normal) / tally.agreeing : 0.0;
  result.residual_mm = tally.agreeing > 0.0 ? tally.residual_mm / tally.agreeing : 0.0;
  const double against = options.contradicted * result.contradicted +
                         options.missing * result.missing + options.hidden * result.hidden +
                         options.buried * result.buried + options.weak * result.weak;
  const double total = result.explained + against;
  result.score = result.explained / (total < 1e-9 ? 1e-9 : total) * outline_factor;
  return result;
}

}  // namespace rangepose
