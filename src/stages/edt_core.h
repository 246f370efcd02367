// One pixel of the ping-pong signed distance transform (paper Sect. 5.2, Algorithm 1).
// Twins: glsl/edt_init.frag, glsl/edt_step.frag, glsl/edt_root.frag.
#pragma once

#include <cmath>

#include "stages/device.h"
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

/// `read(x, y)` gives the texel of the previous pass; coordinates may lie one px outside, where it
/// must give a texel with found = 0.
///
/// Neighbour order (rows, then columns) and strict `<` are part of the contract: on a tie the
/// first site wins, so every back-end yields the same sites.
template <typename Read>
RP_HD EdtTexel edtStep(int x, int y, const Read& read) {
  EdtTexel best = read(x, y);
  const float side = best.signed_sq < 0.0f ? -1.0f : 1.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const EdtTexel near = read(x + dx, y + dy);
      if (near.found == 0.0f) continue;
      const float ex = near.site_x - static_cast<float>(x);
      const float ey = near.site_y - static_cast<float>(y);
      const float sq = ex * ex + ey * ey;
      if (sq < side * best.signed_sq) best = {near.site_x, near.site_y, side * sq, 1.0f};
    }
  }
  return best;
}

/// Signed distance [px] of a texel after the last pass.
RP_HD float edtRoot(const EdtTexel& texel) {
  const float root = std::sqrt(std::abs(texel.signed_sq));
  return texel.signed_sq < 0.0f ? -root : root;
}

}  // namespace rangepose
