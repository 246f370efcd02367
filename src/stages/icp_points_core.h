// What a point adds to a step of projective ICP: its partner in the depth image, or where the data
// ends for a point of a rim (paper Sect. 7). For one point or eight at a time (lanes.h). Shared by
// host and CUDA.
#pragma once

#include "stages/icp_core.h"
#include "stages/posed_points_core.h"

namespace rangepose {

/// What all points of an iteration share, in the numbers that they use.
struct IcpView {
  Placement placement;
  Lens lens;
  float center_mm[3];  ///< of the object's sphere, in the camera frame
  float radii_per_mm;  ///< 1 / radius of that sphere
  float reach_mm;      ///< pairs farther apart are left out
  int search_steps;
  float slide;         ///< share of the point-to-point term
  float rim_reach_mm;  ///< see IcpOptions
  float rim_steps;
  float rim_weight;
  float rim_gap_mm;  ///< data so far behind the rim's surface belongs to something else
};

RP_HD IcpView icpView(const IcpFrame& frame, const IcpOptions& options, const Camera& camera) {
  IcpView view{};
  view.placement = placementOf(frame.pose);
  view.lens = lensOf(camera);
  for (int i = 0; i < 3; ++i) view.center_mm[i] = static_cast<float>(frame.center_mm[i]);
  view.radii_per_mm = static_cast<float>(1.0 / frame.radius_mm);
  view.reach_mm = static_cast<float>(frame.reach_mm);
  view.search_steps = options.search_steps;
  view.slide = static_cast<float>(options.slide);
  view.rim_reach_mm = static_cast<float>(options.rim_reach_mm);
  view.rim_steps = static_cast<float>(options.rim_steps);
  view.rim_weight = static_cast<float>(options.rim_weight);
  view.rim_gap_mm = static_cast<float>(options.last_reach_mm);
  return view;
}

/// Relative to the centre of the object's sphere, in its radii.
template <typename V>
RP_LANES Lane3<V> inRadii(const IcpView& view, const Lane3<V>& a) {
  return {(a.x - view.center_mm[0]) * view.radii_per_mm,
          (a.y - view.center_mm[1]) * view.radii_per_mm,
          (a.z - view.center_mm[2]) * view.radii_per_mm};
}

template <typename V>
struct IcpPartner {
  V squared_mm2;      ///< of the distance; that of the reach where there is none
  Lane3<V> point_mm;  ///< in the camera frame; the point itself where there is none
};

/// Takes the point measured at pixel (x, y) if it is nearer. 0 is no depth.
template <typename V>
RP_LANES void considerPixel(const IcpView& view,
                            const Lane3<V>& point_mm,
                            const V& depth_mm,
                            const typename LanesOf<V>::Int& x,
                            const typename LanesOf<V>::Int& y,
                            IcpPartner<V>& nearest) {
  const Lane3<V> candidate = unprojected<V>(view.lens, x, y, depth_mm);
  const Lane3<V> gap = candidate - point_mm;
  const V squared = dot(gap, gap);
  const typename LanesOf<V>::Mask nearer = depth_mm != 0.0f && squared < nearest.squared_mm2;
  nearest.squared_mm2 = pick(nearer, squared, nearest.squared_mm2);
  nearest.point_mm.x = pick(nearer, candidate.x, nearest.point_mm.x);
  nearest.point_mm.y = pick(nearer, candidate.y, nearest.point_mm.y);
  nearest.point_mm.z = pick(nearer, candidate.z, nearest.point_mm.z);
}

/// The nearest measured point to `point_mm` on a grid of 2 * search_steps + 1 pixels a side, whose
/// spacing follows from the reach; none if the point is hidden or has no partner within the reach,
/// nor where `wanted` does not hold.
template <typename V, typename Read>
RP_LANES IcpPartner<V> icpPartner(const IcpView& view,
                                  const Read& read,
                                  const typename LanesOf<V>::Mask& wanted,
                                  const Lane3<V>& point_mm) {
  using Int = typename LanesOf<V>::Int;
  using Mask = typename LanesOf<V>::Mask;
  IcpPartner<V> nearest{all<V>(view.reach_mm * view.reach_mm), point_mm};
  const PixelOf<V> pixel = pixelOf<V>(view.lens, wanted, point_mm);
  const Int u = pixel.u;
  const Int v = pixel.v;
  const V here = read(pixel.inside, u, v);
  const Mask seen = pixel.inside && !(here != 0.0f && here < point_mm.z - view.reach_mm);
  if (!anyOf(seen)) return nearest;
  const V depth_mm = pick(pixel.in_front, point_mm.z, all<V>(1.0f));
  const V pixel_mm = spread(view.lens, depth_mm) * view.lens.mm_per_px_x;
  considerPixel(view, point_mm, pick(seen, here, V{}), u, v, nearest);
  if (view.search_steps == 0) return nearest;
  const Int share = truncated(view.reach_mm / pixel_mm / asFloat(view.search_steps));
  const Int spacing = pick(share < 1, Int{} + 1, share);
  // The point lies at most half a pixel from its own: no other comes nearer than this, but for the
  // slant of the rays.
  const V others_mm = (asFloat(spacing) - 0.5f) * pixel_mm;
  const Mask open = seen && nearest.squared_mm2 > others_mm * others_mm;
  if (!anyOf(open)) return nearest;
  for (int dv = -view.search_steps; dv <= view.search_steps; ++dv) {
    const Int y = v + dv * spacing;
    const Mask in_row = open && y >= 0 && y < view.lens.height;
    for (int du = -view.search_steps; du <= view.search_steps; ++du) {
      if (du == 0 && dv == 0) continue;
      const Int x = u + du * spacing;
      const V depth = read(in_row && x >= 0 && x < view.lens.width, x, y);
      considerPixel(view, point_mm, depth, x, y, nearest);
    }
  }
  return nearest;
}

template <typename V>
struct RimPartner {
  typename LanesOf<V>::Mask found;
  V beyond_mm;  ///< as far the data goes on beyond the rim; negative where it ends before
};

/// Where the data ends nearest to a rim on the line `out` (unit, the tangent) across it. The data
/// is followed from inside to outside, in the slope of `out`, from where it is first
/// within the view's reach of the line: a pose that is off in depth or slope meets the same end.
/// What lies behind it or was not measured, twice in a row, ends it. Nearer data hides where it
/// ends. `across` is the length of `out` in the image.
template <typename V, typename Read>
RP_LANES RimPartner<V> rimPartner(const IcpView& view,
                                  const Read& read,
                                  const typename LanesOf<V>::Mask& wanted,
                                  const Lane3<V>& point_mm,
                                  const Lane3<V>& out,
                                  const V& across) {
  using Int = typename LanesOf<V>::Int;
  using Mask = typename LanesOf<V>::Mask;
  RimPartner<V> nearest{Mask{}, all<V>(view.rim_reach_mm)};
  const Mask usable = wanted && inFront(view.lens, point_mm) && across > 0.1f;
  const Lane3<V> point{point_mm.x, point_mm.y, pick(usable, point_mm.z, all<V>(1.0f))};
  // A pixel or more a step. Over so short a way the line's image is taken as evenly spaced.
  const V pixel_mm = spread(view.lens, point.z) * view.lens.mm_per_px_x;
  const V share_mm = all<V>(view.rim_reach_mm / view.rim_steps);
  const V step_mm = pick(pixel_mm < share_mm, share_mm, pixel_mm);
  const V scale = step_mm / pick(usable, across, all<V>(1.0f));
  const Lane3<V> next{point.x + out.x * scale, point.y + out.y * scale, point.z + out.z * scale};
  const ImagePoint<V> pixel = projected(view.lens, point);
  const ImagePoint<V> pixel_next = projected(view.lens, next);
  const V du = pixel_next.u - pixel.u;
  const V dv = pixel_next.v - pixel.v;
  const V reach_steps = view.rim_reach_mm / step_mm;
  const V u_margin = (reach_steps + 3.0f) * magnitude(du) + 0.5f;
  const V v_margin = (reach_steps + 3.0f) * magnitude(dv) + 0.5f;
  // Not "outside", so that a NaN counts as outside too.
  Mask running = usable && pixel.u > u_margin &&
                 pixel.u < asFloat(view.lens.width - 1) - u_margin && pixel.v > v_margin &&
                 pixel.v < asFloat(view.lens.height - 1) - v_margin;
  // At least the reach, in whole steps.
  const Int steps = truncated(pick(running, reach_steps, V{})) + 2;
  const V line_step = out.z * scale;
  V i = -asFloat(steps);
  V u = pixel.u + 0.5f + i * du;
  V v = pixel.v + 0.5f + i * dv;
  V expected_mm = point.z + i * line_step;  // on the line; where followed, of the data
  Mask followed{};
  Mask on{};
  Mask ended_once{};  // not on, after a step that was
  while (anyOf(running)) {
    const V seen = read(running, truncated(u), truncated(v));
    const V behind = seen - expected_mm;
    const Mask known = seen != 0.0f;
    const Mask begins = both(known, both(!followed, magnitude(behind) < view.reach_mm));
    followed = either(followed, begins);
    const Mask before = both(known, behind < -view.rim_gap_mm);
    const Mask was_on = on;
    on = both(known, either(begins, magnitude(behind) <= view.rim_gap_mm));
    const Mask off = !either(on, before);
    // The data was there two steps ago for the last time.
    const V beyond_mm = (i - 1.5f) * step_mm;
    const V nearest_mm = magnitude(nearest.beyond_mm);
    const Mask ends = both(both(running, both(ended_once, off)), magnitude(beyond_mm) < nearest_mm);
    nearest.beyond_mm = pick(ends, beyond_mm, nearest.beyond_mm);
    ended_once = both(off, was_on);
    expected_mm = pick(on, seen, expected_mm) + line_step;
    // Whether what the next step may end is nearer.
    running = both(running, (i - 0.5f) * step_mm < magnitude(nearest.beyond_mm));
    i += 1.0f;
    u += du;
    v += dv;
  }
  nearest.found = magnitude(nearest.beyond_mm) < view.rim_reach_mm;
  return nearest;
}

/// Adds a point of a rim with its partner, both in the camera frame, and says whether it has one.
/// Its row says how far the rim moves across itself in the image, which motion along the line of
/// sight does not change. Without weight in the sums that tell how well faces fit.
template <typename V, typename Read>
RP_LANES typename LanesOf<V>::Mask addRim(IcpSumsOf<V>& sums,
                                          const IcpView& view,
                                          const Read& read,
                                          const typename LanesOf<V>::Mask& wanted,
                                          const Lane3<V>& point_mm,
                                          const Lane3<V>& out) {
  const V across = squareRoot(out.x * out.x + out.y * out.y);
  const RimPartner<V> partner = rimPartner(view, read, wanted, point_mm, out, across);
  if (!anyOf(partner.found)) return partner.found;
  const V length = pick(partner.found, across, all<V>(1.0f));
  Lane3<V> n{out.x / length, out.y / length, V{}};
  if (!view.lens.orthographic) {
    const V depth_mm = pick(partner.found, point_mm.z, all<V>(1.0f));
    n.z = -(n.x * point_mm.x + n.y * point_mm.y) / depth_mm;
  }
  const V residual = partner.beyond_mm * dot(n, out) * view.radii_per_mm / length;
  const V ratio = partner.beyond_mm / view.rim_reach_mm;
  const V rest = 1.0f - ratio * ratio;
  const Lane3<V> turn = cross(inRadii(view, point_mm), n);
  addRow<V>(sums,
            {turn.x, turn.y, turn.z, n.x, n.y, n.z},
            residual,
            pick(partner.found, view.rim_weight * (rest * rest), V{}));
  return partner.found;
}

/// Adds a point of a face with its partner, likewise. The weight is Tukey's over the reach.
template <typename V, typename Read>
RP_LANES typename LanesOf<V>::Mask addFace(IcpSumsOf<V>& sums,
                                           const IcpView& view,
                                           const Read& read,
                                           const typename LanesOf<V>::Mask& wanted,
                                           const Lane3<V>& point_mm,
                                           const Lane3<V>& normal) {
  const IcpPartner<V> partner = icpPartner(view, read, wanted, point_mm);
  const float squared_reach = view.reach_mm * view.reach_mm;
  const V rest = 1.0f - partner.squared_mm2 / squared_reach;
  addPair(sums,
          inRadii(view, point_mm),
          normal,
          inRadii(view, partner.point_mm),
          rest * rest,
          view.slide);
  return partner.squared_mm2 < squared_reach;
}

/// Adds points with their partners, and says which have one. All are of rims, or none is.
template <typename V, typename Read>
RP_LANES typename LanesOf<V>::Mask addPoints(
    IcpSumsOf<V>& sums, const IcpView& view, const Read& read, const PointsOf<V>& own, bool rim) {
  const Lane3<V> point = placed(view.placement, own.position_mm);
  const Lane3<V> normal = turned(view.placement, own.normal);
  return rim ? addRim(sums, view, read, own.wanted, point, normal)
             : addFace(sums, view, read, own.wanted, point, normal);
}

/// Whether a point can have a partner at all.
RP_HD bool isAligned(const SurfacePoint& point, const IcpOptions& options) {
  return !point.rim || options.rim_reach_mm > 0.0;
}

}  // namespace rangepose
