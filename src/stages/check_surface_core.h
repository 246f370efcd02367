// The verdict on a rendered surface: its pixels, its outline and its relief. Shared by host and
// CUDA.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "geometry/mesh.h"
#include "stages/check_core.h"
#include "stages/relief_core.h"
#include "stages/surface.h"

namespace rangepose {

/// Sums over a rendered surface. Nothing but doubles, see PixelTally.
struct SurfaceTally {
  PixelTally<double> pixels;
  double border = 0.0;
  double border_ends = 0.0;
  double border_covered = 0.0;
  double visible_mm2 = 0.0;
  double seen_through = 0.0;
  double inner = 0.0;
  ReliefSums relief;
  ReliefSums whole;  ///< of the surface itself, as if all of it were seen
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

  static constexpr int kOut = 2;  ///< what lies beside an outline is looked at so far away [px]

  /// One pixel, its part of the outline and of the relief.
  RP_HD void judge(const SurfaceTexel& texel, int x, int y, SurfaceTally& tally) const {
    if (texel.w <= 0.0f) return;
    const double width_mm = spacingMm(texel);
    tally.visible_mm2 += width_mm * width_mm;
    const Lane3<float> normal{texel.x, texel.y, texel.z};
    const PixelVerdict<float> verdict =
        judgePixel(rules, measured.read, true, u(x), v(y), normal, texel.w);
    addVerdict(tally.pixels, true, verdict);
    judgeBorder(texel, x, y, tally);
    judgeRelief(texel, x, y, verdict.gap.agrees, tally);
  }

  /// Whether an outline or a jump of depth of the surface itself runs beside a pixel: sensors smear
  /// depth there, and shift it by a pixel.
  RP_HD bool isRim(const SurfaceTexel& texel, int x, int y) const {
    const double depth_mm = static_cast<double>(texel.w);
    // Of less, a slope or what a pose is off may be the cause.
    const double jump_mm = 1.5 * rules.options.tolerance_mm + 3.0 * spacingMm(texel);
    for (int direction = 0; direction < 4; ++direction) {
      const int dx = direction == 0 ? 1 : direction == 1 ? -1 : 0;
      const int dy = direction == 2 ? 1 : direction == 3 ? -1 : 0;
      const double beside = static_cast<double>(surface_depth(x + dx, y + dy));
      if (beside <= 0.0 || std::abs(beside - depth_mm) > jump_mm) return true;
    }
    return false;
  }

  /// What a pixel inside of the surface says, whatever the sensor does to jumps.
  RP_HD void judgeRelief(
      const SurfaceTexel& texel, int x, int y, bool agrees, SurfaceTally& tally) const {
    constexpr double kWide = 2.0;  // tolerances
    if (isRim(texel, x, y)) return;
    const double slope = static_cast<double>(std::abs(texel.z));
    const double slant = slope > kLeastSlant ? slope : kLeastSlant;
    const double across = 2.0 * x / window.width - 1.0;
    const double down = 2.0 * y / window.height - 1.0;
    const double own = static_cast<double>(texel.w);
    tally.whole.add(across, down, own - sphere.center_mm.z, 0.0, slant);
    const double seen = measured.at(u(x), v(y));
    if (seen == 0.0) return;
    const double off_mm = (seen - own) * slant;
    const double limit_mm = kWide * rules.options.tolerance_mm;
    if (off_mm < -limit_mm) return;
    if (agrees) tally.inner += window.step * window.step;
    if (off_mm > limit_mm) {
      tally.seen_through += 1.0;
      return;
    }
    tally.relief.add(across, down, seen - sphere.center_mm.z, off_mm, slant);
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
        }
      }
    }
  }

 private:
  RP_HD int u(int x) const { return window.x0 + x * window.step; }
  RP_HD int v(int y) const { return window.y0 + y * window.step; }
  RP_HD double spacingMm(const SurfaceTexel& texel) const {
    return window.step * measured.camera.pixelSpacingMm(static_cast<double>(texel.w));
  }
};

/// Share of the outline where the data ends with the model.
RP_HD double outlineOf(const SurfaceTally& tally) {
  return tally.border > 0.0 ? tally.border_ends / tally.border : 0.0;
}

/// Below this nothing is measured [tolerances].
inline constexpr double kLeastDeviation = 0.01;

/// A right pose is off the data by more than the sensor's error: by its own, and the part's.
inline constexpr double kRightPoseErrors = 2.0;

/// Of a rendered surface.
RP_HD CheckResult surfaceVerdict(const SurfaceTally& tally, const CheckOptions& options) {
  const PixelTally<double>& pixels = tally.pixels;
  const double outline = outlineOf(tally);
  CheckResult result = summarizeCheck(
      pixels, options, 1.0 - options.border + options.border * outline, tally.visible_mm2);
  result.outline = outline;
  result.outline_covered = tally.border > 0.0 ? tally.border_covered / tally.border : 0.0;
  result.seen_through = pixels.pixels > 0.0 ? tally.seen_through / pixels.pixels : 0.0;
  const double least_mm = kLeastDeviation * options.tolerance_mm;
  result.relief = reliefOf(tally.relief, least_mm);
  result.whole_relief = reliefOfWhole(tally.whole, kRightPoseErrors * options.error_mm, least_mm);
  result.inner_px = tally.inner;
  return result;
}

}  // namespace rangepose
