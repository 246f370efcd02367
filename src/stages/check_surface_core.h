// The verdict on a rendered surface: its pixels, its outline and its jumps of depth. Shared by host
// and CUDA.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "geometry/mesh.h"
#include "geometry/stability.h"
#include "stages/check_core.h"
#include "stages/surface.h"

namespace rangepose {

/// Sums over a rendered surface. Nothing but doubles, see PixelTally.
struct SurfaceTally {
  PixelTally<double> pixels;
  double border = 0.0;
  double border_ends = 0.0;
  double border_covered = 0.0;
  double visible_mm2 = 0.0;
  double jumps = 0.0;
  double jumps_met = 0.0;
  double jumps_missed = 0.0;
  StabilityCovariance covariance;  ///< sums
};

/// Reads the measured surface at camera pixels, see posed_points_core.h.
template <typename Read>
struct Measured {
  const Camera& camera;
  const Read& read;

  RP_HD bool inImage(int u, int v) const {
    return u >= 0 && v >= 0 && u < camera.width && v < camera.height;
  }
  RP_HD double at(int u, int v) const { return static_cast<double>(read(inImage(u, v), u, v)); }

  /// Sine of the angle between a plane and the way from one measured point to another; 1 where the
  /// other was not measured.
  RP_HD double riseAlong(const glm::dvec3& normal, int u, int v, int to_u, int to_v) const {
    const double there = at(to_u, to_v);
    if (there == 0.0) return 1.0;
    const glm::dvec3 way = camera.unproject(to_u, to_v, there) - camera.unproject(u, v, at(u, v));
    return std::abs(glm::dot(normal, way)) / glm::length(way);
  }
};

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
    tally.visible_mm2 += width_mm * width_mm;
    const Lane3<float> normal{texel.x, texel.y, texel.z};
    const PixelVerdict<float> verdict =
        judgePixel(rules, measured.read, true, u(x), v(y), normal, texel.w);
    addVerdict(tally.pixels, true, verdict, normal);
    if (verdict.gap.agrees) tally.covariance.add(inRadii(texel, x, y), glm::dvec3(texel), 1.0);
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
      tally.border += 1.0;
      if (covered || !measured.inImage(out_u, out_v)) {
        tally.border_ends += 0.5;
        tally.border_covered += 1.0;
        continue;
      }
      // Nearer data may cover the outline; farther or missing data ends the surface.
      if (outside == 0.0) {
        tally.border_ends += 1.0;
      } else if (outside > model + 1.5 * tolerance_mm) {
        tally.border_ends += 1.0;
        if (inside != 0.0 && inside < model + 1.5 * tolerance_mm)
          addEnd(texel, x, y, dx, dy, tally);
      } else if (outside < model - 1.5 * tolerance_mm) {
        tally.border_ends += 0.5;
        tally.border_covered += 1.0;
      } else if (inside != 0.0) {
        // Rough data bends anywhere: an edge is where it follows the model up to its outline.
        const glm::dvec3 normal(texel);
        const double out_sine = measured.riseAlong(normal, u(x), v(y), out_u, out_v);
        const double back_sine =
            measured.riseAlong(normal, u(x), v(y), u(x - kOut * dx), v(y - kOut * dy));
        if (out_sine > kBentSine && back_sine < kBentSine) {
          tally.border_ends += 1.0;
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

/// Share of the outline where the data ends with the model.
RP_HD double outlineOf(const SurfaceTally& tally) {
  return tally.border > 0.0 ? tally.border_ends / tally.border : 0.0;
}

/// Of a rendered surface.
RP_HD CheckResult surfaceVerdict(const SurfaceTally& tally, const CheckOptions& options) {
  constexpr double kFewJumps = 2.0;  // of which no share is known
  const PixelTally<double>& pixels = tally.pixels;
  const double outline = outlineOf(tally);
  CheckResult result = summarizeCheck(
      pixels, options, 1.0 - options.border + options.border * outline, tally.visible_mm2);
  result.outline = outline;
  result.outline_covered = tally.border > 0.0 ? tally.border_covered / tally.border : 0.0;
  result.jumps_met = (tally.jumps_met + kFewJumps) / (tally.jumps + 2.0 * kFewJumps);
  result.jumps_missed = tally.jumps_missed / std::sqrt(pixels.pixels < 1.0 ? 1.0 : pixels.pixels);
  const double agreeing = pixels.agreeing < 1.0 ? 1.0 : pixels.agreeing;
  result.covariance = tally.covariance;
  result.covariance.scale(1.0 / agreeing);
  return result;
}

}  // namespace rangepose
