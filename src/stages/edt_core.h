// One pixel of the ping-pong signed distance transform (paper Sect. 5.2, Algorithm 1).
// Twins: glsl/edt_init.frag, glsl/edt_step.frag, glsl/edt_root.frag.
#pragma once

#include <cmath>

#include "core/host_device.h"
#include "stages/lanes.h"
#include "stages/scene_channels.h"

namespace rangepose {

/// Distances are kept squared: integers below 2^24, exact in a float.
RP_HD EdtTexel edtInit(int x, int y, float range, float edge, int passes) {
  const float far = static_cast<float>((passes + 1) * (passes + 1));
  const float fx = static_cast<float>(x);
  const float fy = static_cast<float>(y);
  if (edge != 0.0f) return {fx, fy, 0.0f, 1.0f};
  return {fx, fy, range != 0.0f ? far : -far, 0.0f};
}

/// A pass for the pixels at `x`, `y`: one, or a row of eight. `read(dx, dy)` gives their texels of
/// the previous pass, shifted; they may lie one px outside, where it must give found = 0. A Texel
/// has the fields of EdtTexel.
///
/// Neighbour order (rows, then columns) and strict `<` are part of the contract: on a tie the
/// first site wins, so every back-end yields the same sites.
template <typename Texel, typename V, typename Read>
RP_LANES Texel edtStepOf(const V& x, const V& y, const Read& read) {
  Texel best = read(0, 0);
  const V none = V{};
  const V one = none + 1.0f;
  const V side = pick(best.signed_sq < none, none - one, one);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Texel near = read(dx, dy);
      const V ex = near.site_x - x;
      const V ey = near.site_y - y;
      const V sq = ex * ex + ey * ey;
      const auto nearer = both(near.found != none, sq < side * best.signed_sq);
      best.site_x = pick(nearer, near.site_x, best.site_x);
      best.site_y = pick(nearer, near.site_y, best.site_y);
      best.signed_sq = pick(nearer, side * sq, best.signed_sq);
      best.found = pick(nearer, one, best.found);
    }
  }
  return best;
}

/// The same for one pixel, with `read(x, y)`.
template <typename Read>
RP_HD EdtTexel edtStep(int x, int y, const Read& read) {
  return edtStepOf<EdtTexel>(static_cast<float>(x), static_cast<float>(y), [&](int dx, int dy) {
    return read(x + dx, y + dy);
  });
}

/// Signed distance [px] of a texel after the last pass.
RP_HD float edtRoot(const EdtTexel& texel) {
  const float root = std::sqrt(std::abs(texel.signed_sq));
  return texel.signed_sq < 0.0f ? -root : root;
}

}  // namespace rangepose
