// What the search is given and what it answers (paper Sect. 6).
#pragma once

#include <vector>

#include "core/glm.h"
#include "core/host_device.h"
#include "stages/error_core.h"
#include "stages/reference.h"
#include "stages/simplex_core.h"

namespace rangepose {

/// A scene window is this many reference widths wide and high (paper Sect. 5: 128 for 64).
inline constexpr int kWindowScale = 2;

struct SearchOptions {
  SimplexOptions simplex;
  ErrorOptions error;
};

/// The best translation of one view in one scene window.
///
/// translation_px: where the centre of the object's bounding sphere lies, relative to the window's
/// centre (x, y) and to its range origin (z) [px]. A reference pixel (u, v) is read against window
/// pixel (u + margin + floor(x + 0.5), ...), margin = (window width - size) / 2, and predicts the
/// range g - size + z.
struct Hypothesis {
  int view = 0;
  int window = 0;
  glm::vec3 translation_px{0.0f};
  float error = kWorstError;  ///< Eq. 1
  int iterations = 0;
};

/// A shift beyond this is worth kWorstError: the object would have left the window [px]. Window
/// pixels that are read outside of the window count as background.
RP_HD float maxShiftPx(int size) { return 0.75f * static_cast<float>(size); }

/// Where the simplex of a view starts: the view's anchor (its own most inner pixel) is laid on the
/// window's centre at the seed's range. Differs from the paper: it lays the middle of the tile
/// there, which for a bent part may be a hole.
RP_HD glm::vec3 startTranslation(const glm::vec3& anchor_px, int size, float seed_range_px) {
  // Window pixel of the anchor: u + margin + x must be the window's centre pixel, margin + size
  // / 2.
  const float width = static_cast<float>(size);
  return {0.5f * width - anchor_px.x,
          0.5f * width - anchor_px.y,
          seed_range_px - (anchor_px.z - width)};
}
glm::vec3 startTranslation(const ReferenceObject& object, int view, float seed_range_px);

}  // namespace rangepose
