// The verdict on a pose, pixel by pixel: shared by host and CUDA.
#pragma once

#include <cmath>

#include "core/camera.h"
#include "core/host_device.h"
#include "stages/posed_points_core.h"

namespace rangepose {

struct CheckOptions {
  double tolerance_mm = 2.0;     ///< surfaces this close are the same [mm]
  double error_mm = 0.1;         ///< standard deviation of what the sensor is off [mm]
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
  double seen_through = 0.0;     ///< in front of the data by more than twice the tolerance, and not
                                 ///< beside an outline or a jump, where sensors smear depth
  double relief = 0.0;  ///< reliefOf() what agrees: how much likelier it is with the part there
                        ///< than with a smooth surface, logarithm for a pixel, -1..3
  double whole_relief = 0.0;   ///< relief that there would be if all of the surface were seen by
                               ///< this sensor, 0..3
  double inner_px = 0.0;       ///< agreeing pixels that are not beside an outline or a jump [px]
  double residual_mm = 0.0;    ///< mean absolute depth difference of the explained surface [mm]
  double explained_mm2 = 0.0;  ///< explained surface as the camera sees it [mm^2]
  int pixels = 0;              ///< rendered pixels
  double score = 0.0;          ///< 0..1, higher is better
};

/// Sums over the pixels of a model. Nothing but one kind of number, so that a block of threads can
/// add them up like an array.
template <typename Number>
struct PixelTally {
  Number explained{};
  Number contradicted{};
  Number hidden{};
  Number buried{};
  Number missing{};
  Number weak{};
  Number residual_mm{};
  Number agreeing{};
  Number pixels{};
};

/// See CheckOptions.
struct GapLimits {
  float tolerance_mm;
  float buried_mm;
};

RP_HD GapLimits gapLimits(const CheckOptions& options) {
  return {static_cast<float>(options.tolerance_mm),
          static_cast<float>(options.buried_tolerances * options.tolerance_mm)};
}

/// What all pixels of a model are judged by.
struct CheckRules {
  CheckOptions options;
  Lens lens;
  GapLimits limits;
  float least_cosine;  ///< of normals of the same surface
  int normal_reach;    ///< the data's slope is taken between points that far away [px]
};

/// `normal_reach` of points, which have no window that they were rendered with [px].
inline constexpr int kPointNormalReach = 2;

RP_HD CheckRules checkRules(const CheckOptions& options, const Camera& camera, int normal_reach) {
  return {options,
          lensOf(camera),
          gapLimits(options),
          static_cast<float>(std::cos(options.max_tilt_rad)),
          normal_reach};
}

/// Slopes steeper than that, by the cosine, are not looked at more leniently.
inline constexpr double kLeastSlant = 0.3;

/// Where one pixel of a model (V = float) or eight (Float8, see lanes.h) lie from the data.
template <typename V>
struct GapOf {
  typename LanesOf<V>::Mask agrees, contradicted, buried, hidden;  ///< one where known
  V distance_mm;  ///< along the model's normal: on a slope it is smaller than along the ray
};

template <typename V>
RP_LANES GapOf<V> gapOf(const GapLimits& limits,
                        const typename LanesOf<V>::Mask& known,
                        const V& normal_z,
                        const V& model_mm,
                        const V& seen_mm) {
  const V slant = magnitude(normal_z);
  const V least = all<V>(static_cast<float>(kLeastSlant));
  const V distance = magnitude(seen_mm - model_mm) * pick(slant > least, slant, least);
  const auto near = distance <= limits.tolerance_mm;
  const auto off = both(known, !near);
  const auto before = seen_mm > model_mm;
  const auto just = distance <= limits.buried_mm;
  return {both(known, near),
          both(off, before),
          both(off, both(!before, just)),
          both(off, both(!before, !just)),
          distance};
}

template <typename V>
struct PixelVerdict {
  GapOf<V> gap;
  typename LanesOf<V>::Mask missing;
  V agreement;  ///< 0..1
};

/// From the point at pixel (u - du, v - dv) to that at (u + du, v + dv); unknown where the surface
/// ends.
template <typename V>
struct SlopeOf {
  typename LanesOf<V>::Mask known;
  Lane3<V> way_mm;
};

template <typename V, typename Read>
RP_LANES SlopeOf<V> slopeAt(const CheckRules& rules,
                            const Read& read,
                            const typename LanesOf<V>::Mask& wanted,
                            const typename LanesOf<V>::Int& u,
                            const typename LanesOf<V>::Int& v,
                            const V& here_mm,
                            int du,
                            int dv) {
  const Lens& lens = rules.lens;
  const auto inside =
      both(wanted, both(inImage<V>(lens, u - du, v - dv), inImage<V>(lens, u + du, v + dv)));
  const V before = read(inside, u - du, v - dv);
  const V after = read(inside, u + du, v + dv);
  // Where the surface bends by more than the tolerance it is not one surface.
  const auto one =
      both(both(before != 0.0f, after != 0.0f),
           magnitude(before + after - 2.0f * here_mm) <= 4.0f * rules.limits.tolerance_mm);
  return {
      one,
      unprojected<V>(lens, u + du, v + dv, after) - unprojected<V>(lens, u - du, v - dv, before)};
}

/// A model's surface at camera pixel (u, v), its normal towards the camera, against the data.
template <typename V, typename Read>
RP_LANES PixelVerdict<V> judgePixel(const CheckRules& rules,
                                    const Read& read,
                                    const typename LanesOf<V>::Mask& wanted,
                                    const typename LanesOf<V>::Int& u,
                                    const typename LanesOf<V>::Int& v,
                                    const Lane3<V>& normal,
                                    const V& depth_mm) {
  const auto inside = both(wanted, inImage<V>(rules.lens, u, v));
  const V seen = read(inside, u, v);
  const auto known = both(inside, seen != 0.0f);
  PixelVerdict<V> verdict;
  verdict.gap = gapOf(rules.limits, known, normal.z, depth_mm, seen);
  verdict.missing = both(wanted, !known);
  const auto agrees = verdict.gap.agrees;
  const V ratio = verdict.gap.distance_mm / rules.limits.tolerance_mm;
  verdict.agreement = pick(agrees, V(1.0f - 0.5f * ratio * ratio), V{});
  if (!anyOf(agrees)) return verdict;
  const int reach = rules.normal_reach;
  const SlopeOf<V> across = slopeAt<V>(rules, read, agrees, u, v, seen, reach, 0);
  const SlopeOf<V> down = slopeAt<V>(rules, read, agrees, u, v, seen, 0, reach);
  const Lane3<V> data = cross(down.way_mm, across.way_mm);
  const auto tilted = dot(data, normal) < rules.least_cosine * squareRoot(dot(data, data));
  verdict.agreement = pick(
      both(both(across.known, down.known), tilted), V(0.3f * verdict.agreement), verdict.agreement);
  return verdict;
}

/// Adds what was `wanted`.
template <typename Number, typename V>
RP_LANES void addVerdict(PixelTally<Number>& tally,
                         const typename LanesOf<V>::Mask& wanted,
                         const PixelVerdict<V>& verdict) {
  const V one = all<V>(1.0f);
  const GapOf<V>& gap = verdict.gap;
  tally.pixels += pick(wanted, one, V{});
  tally.missing += pick(verdict.missing, one, V{});
  tally.contradicted += pick(gap.contradicted, one, V{});
  tally.buried += pick(gap.buried, one, V{});
  tally.hidden += pick(gap.hidden, one, V{});
  tally.agreeing += pick(gap.agrees, one, V{});
  tally.explained += verdict.agreement;
  tally.weak += pick(gap.agrees, V(1.0f - verdict.agreement), V{});
  tally.residual_mm += pick(gap.agrees, gap.distance_mm, V{});
}

/// Points of an object; those of rims must not be wanted.
template <typename V, typename Read>
RP_LANES void judgePoints(const CheckRules& rules,
                          const Placement& placement,
                          const Read& read,
                          const PointsOf<V>& own,
                          PixelTally<V>& tally) {
  const Lane3<V> point = placed(placement, own.position_mm);
  const Lane3<V> normal = turned(placement, own.normal);
  const PixelOf<V> pixel = pixelOf<V>(rules.lens, own.wanted, point);
  // What is not in the image was not measured.
  const typename LanesOf<V>::Int none = typename LanesOf<V>::Int{} - 1;
  const typename LanesOf<V>::Int u = pick(pixel.inside, pixel.u, none);
  const PixelVerdict<V> verdict =
      judgePixel(rules, read, pixel.in_front, u, pixel.v, normal, point.z);
  addVerdict(tally, pixel.in_front, verdict);
}

/// Shares and score; `outline_factor` is what the outline leaves of the score.
template <typename Number>
RP_HD CheckResult summarizeCheck(const PixelTally<Number>& tally,
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
  result.residual_mm = tally.agreeing > 0.0 ? tally.residual_mm / tally.agreeing : 0.0;
  const double against = options.contradicted * result.contradicted +
                         options.missing * result.missing + options.hidden * result.hidden +
                         options.buried * result.buried + options.weak * result.weak;
  const double total = result.explained + against;
  result.score = result.explained / (total < 1e-9 ? 1e-9 : total) * outline_factor;
  return result;
}

}  // namespace rangepose
