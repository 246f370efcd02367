// What the search reads on the device: views without their background, windows with a frame of it.
#pragma once

#include <cmath>

#include "core/host_device.h"
#include "stages/search.h"

namespace rangepose::cuda {

/// A pixel of a view that shows the object. 16 bytes: one load.
struct alignas(16) ViewPixel {
  float distance = 0.0f;  ///< signed distance to the nearest edge [px]
  float range = 0.0f;     ///< as in ReferenceTexel [px]
  float cosine = 0.0f;    ///< |cos(view, normal)|; 0: weighs nothing
  int place = 0;          ///< in its tile: u + 65536 * v
};

/// Where a view's pixels lie, and what does not depend on the translation.
struct ViewEntry {
  /// Pixels that are summed, and those of them with f = 1 (Eq. 4).
  struct Rows {
    int count = 0;
    float cover_count = 0.0f;
  };

  int first = 0;  ///< of its pixels; those of even rows of the tile come first
  Rows all;
  Rows even;  ///< see ErrorOptions::row_step
  float area_px = 0.0f;
  glm::vec3 anchor_px{0.0f};
};

/// Texel of a framed window. 8 bytes: one load.
struct alignas(8) WindowTexel {
  float range = 0.0f;     ///< [px], 0 = background or hole
  float distance = 0.0f;  ///< signed distance to the nearest edge [px]
};

/// Windows are copied into the middle of a square of background, wide enough that no tile which is
/// shifted by up to maxShiftPx reads past it: the inner loop needs no test for the border.
struct WindowFrame {
  int width = 0;   ///< of a window [px]
  int pad = 0;     ///< background on each side [px]
  int origin = 0;  ///< column and row of a tile's pixel (0, 0) for a shift of 0 [px]

  RP_HD int stride() const { return width + 2 * pad; }
  /// Texels of one window.
  RP_HD int texels() const { return stride() * stride(); }
};

/// Threads of a block of the fused search.
inline constexpr int kSearchThreads = 256;

/// Pixels that each thread keeps in registers in a search of views of at most `most_pixels`: 3, 6
/// or 12; 0 where they do not fit and are read again at each evaluation.
RP_HD int searchSlots(int most_pixels) {
  for (const int slots : {3, 6, 12}) {
    if (most_pixels <= slots * kSearchThreads) return slots;
  }
  return 0;
}

/// For windows of `width` pixels and tiles of `size`.
RP_HD WindowFrame windowFrame(int width, int size) {
  // The same margin as PaddedWindow of the host and the shaders.
  const int margin = (width - size) / 2;
  const int reach = static_cast<int>(std::ceil(maxShiftPx(size))) + 1 - margin;
  WindowFrame frame;
  frame.width = width;
  frame.pad = reach < 0 ? 0 : reach;
  frame.origin = frame.pad + margin;
  return frame;
}

/// What all searches of a launch share.
struct SearchSetup {
  int size = 64;               ///< of a tile [px]
  int views = 0;               ///< of the object
  float max_area_px = 0.0f;    ///< of the object's views
  float lambda_per_px = 0.0f;  ///< weight of E_range
  RangeRule range{};
  AreaFactor area = AreaFactor::kIntended;
  int row_step = 1;
  SimplexOptions simplex;
  WindowFrame frame;
};

}  // namespace rangepose::cuda
