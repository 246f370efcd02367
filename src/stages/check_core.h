// The verdict on a pose, pixel by pixel: shared by host and CUDA.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "geometry/mesh.h"
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

/// Of a rendered surface. Nothing but doubles, likewise.
struct SurfaceTally {
  CheckTally pixels;
  double jumps = 0.0;
  double jumps_met = 0.0;
  double jumps_missed = 0.0;
  StabilityCovariance covariance;  ///< sums
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

/// What a rendered surface is judged with. `surface_depth(x, y)` gives the depth of its pixel [mm],
/// 0 where it shows nothing or has no pixel.
template <typename Depth, typename Read>
struct RenderedSurface {
  const Depth& surface_depth;
  const SurfaceWindow& window;
  const Measured<Read>& measured;
  const Sphere& sphere;  ///< around the object, in the camera frame
  const CheckRules& rules;

  static constexpr int kOut = 2;  ///< what lies beside a pixel is looked at so far away [px]

  /// One pixel, its part of the outline and the jumps of depth beside it.
  RP_HD void judge(const SurfaceTexel& texel, int x, int y, SurfaceTally& tally) const {
    if (texel.w <= 0.0f) return;
    const double width_mm = spacingMm(texel);
    tally.pixels.visible_mm2 += width_mm * width_mm;
    judgePixel(texel, measured, u(x), v(y), rules, tally.pixels);
    const double seen = measured.at(u(x), v(y));
    if (seen != 0.0 && gapKind(texel, seen, rules.options) == GapKind::kAgrees)
      tally.covariance.add(inRadii(texel, x, y), glm::dvec3(texel), 1.0);
    judgeBorder(texel, x, y, tally);
    const int beside = window.step < 2 ? kOut : 1;
    judgeJump(texel, x, y, beside, 0, tally);
    judgeJump(texel, x, y, 0, beside, tally);
  }

  /// Whether the data goes on beyond the outline at a pixel: near its depth and in its slope, where
  /// an edge at which the part touches something is an end.
  RP_HD void judgeBorder(const SurfaceTexel& texel, int x, int y, SurfaceTally& tally) const {
    constexpr double kBentSine = 0.5;  // 30 degrees
    const double tolerance_mm = rules.options.tolerance_mm;
    const double model = static_cast<double>(texel.w);
    const double inside = measured.at(u(x), v(y));
    CheckTally& pixels = tally.pixels;
    // Behind nearer data, over holes and outside of the image nothing can be said: that counts
    // half.
    const bool covered = inside < model - tolerance_mm;
    for (int direction = 0; direction < 4; ++direction) {
      const int dx = direction == 0 ? 1 : direction == 1 ? -1 : 0;
      const int dy = direction == 2 ? 1 : direction == 3 ? -1 : 0;
      if (surface_depth(x + dx, y + dy) > 0.0f) continue;
      const int out_u = u(x + kOut * dx);
      const int out_v = v(y + kOut * dy);
      const double outside = measured.at(out_u, out_v);
      pixels.border += 1.0;
      if (covered || !measured.inImage(out_u, out_v)) {
        pixels.border_ends += 0.5;
        pixels.border_covered += 1.0;
        continue;
      }
      // Nearer data may cover the outline; farther or missing data ends the surface.
      if (outside == 0.0) {
        pixels.border_ends += 1.0;
      } else if (outside > model + 1.5 * tolerance_mm) {
        pixels.border_ends += 1.0;
        if (inside != 0.0 && inside < model + 1.5 * tolerance_mm)
          addEnd(texel, x, y, dx, dy, tally);
      } else if (outside < model - 1.5 * tolerance_mm) {
        pixels.border_ends += 0.5;
        pixels.border_covered += 1.0;
      } else if (inside != 0.0) {
        // Rough data bends anywhere: an edge is where it follows the model up to its outline.
        const glm::dvec3 normal(texel);
        const double out_sine = measured.riseAlong(normal, u(x), v(y), out_u, out_v);
        const double back_sine =
            measured.riseAlong(normal, u(x), v(y), u(x - kOut * dx), v(y - kOut * dy));
        if (out_sine > kBentSine && back_sine < kBentSine) {
          pixels.border_ends += 1.0;
          addEnd(texel, x, y, dx, dy, tally);
        }
      }
    }
  }

  /// A part whose inner jumps of depth are in the data as well is not there by chance. `dx` and
  /// `dy` lead to the pixel on the other side.
  RP_HD void judgeJump(
      const SurfaceTexel& texel, int x, int y, int dx, int dy, SurfaceTally& tally) const {
    const double tolerance_mm = rules.options.tolerance_mm;
    const double here = static_cast<double>(texel.w);
    const double there = static_cast<double>(surface_depth(x + dx, y + dy));
    const double jump = there - here;
    // Of less, a slope or what a pose is off may be the cause.
    if (there <= 0.0 || std::abs(jump) < 1.5 * tolerance_mm + (dx + dy) * spacingMm(texel)) return;
    const double seen_here = measured.at(u(x), v(y));
    const double seen_there = measured.at(u(x + dx), v(y + dy));
    if (seen_here == 0.0 || seen_there == 0.0) return;
    const double off_here = std::abs(seen_here - here);
    const double off_there = std::abs(seen_there - there);
    if (off_here > 3.0 * tolerance_mm && off_there > 3.0 * tolerance_mm) return;
    tally.jumps += 1.0;
    if ((jump > 0.0 ? off_here : off_there) >= tolerance_mm) return;  // the nearer side
    const double seen_jump = seen_there - seen_here;
    if (std::abs(seen_jump - jump) < tolerance_mm) {
      tally.jumps_met += 1.0;
    } else if (std::abs(seen_jump) < 0.5 * std::abs(jump)) {
      tally.jumps_missed += 1.0;
    }
  }

 private:
  RP_HD int u(int x) const { return window.x0 + x * window.step; }
  RP_HD int v(int y) const { return window.y0 + y * window.step; }
  RP_HD double spacingMm(const SurfaceTexel& texel) const {
    return window.step * measured.camera.pixelSpacingMm(static_cast<double>(texel.w));
  }
  RP_HD glm::dvec3 inRadii(const SurfaceTexel& texel, int x, int y) const {
    const glm::dvec3 point = measured.camera.unproject(u(x), v(y), static_cast<double>(texel.w));
    return (point - sphere.center_mm) / sphere.radius_mm;
  }

  /// An outline holds the part across itself. It is a line where faces are areas: one of its pixels
  /// weighs as the strip of the face behind it, a fraction of the radius deep.
  RP_HD void addEnd(
      const SurfaceTexel& texel, int x, int y, int dx, int dy, SurfaceTally& tally) const {
    constexpr double kDepth = 0.5;  // radii
    tally.covariance.add(inRadii(texel, x, y),
                         glm::dvec3(dx, dy, 0.0),
                         kDepth * sphere.radius_mm / spacingMm(texel));
  }
};

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

/// Share of the outline where the data ends with the model.
RP_HD double outlineOf(const CheckTally& tally) {
  return tally.border > 0.0 ? tally.border_ends / tally.border : 0.0;
}

/// Of a rendered surface.
RP_HD CheckResult surfaceVerdict(const SurfaceTally& tally, const CheckOptions& options) {
  constexpr double kFewJumps = 2.0;  // of which no share is known
  const CheckTally& pixels = tally.pixels;
  const double outline = outlineOf(pixels);
  CheckResult result = summarizeCheck(
      pixels, options, 1.0 - options.border + options.border * outline, pixels.visible_mm2);
  result.outline = outline;
  result.outline_covered = pixels.border > 0.0 ? pixels.border_covered / pixels.border : 0.0;
  result.jumps_met = (tally.jumps_met + kFewJumps) / (tally.jumps + 2.0 * kFewJumps);
  result.jumps_missed = tally.jumps_missed / std::sqrt(pixels.pixels < 1.0 ? 1.0 : pixels.pixels);
  const double agreeing = pixels.agreeing < 1.0 ? 1.0 : pixels.agreeing;
  result.covariance = tally.covariance;
  result.covariance.scale(1.0 / agreeing);
  return result;
}

}  // namespace rangepose
