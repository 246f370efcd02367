// What a thread does in the image stages; formulas in src/stages. See block.h.
#pragma once

#include <cstring>

#include "cuda/block.h"
#include "stages/channels_core.h"
#include "stages/resample_core.h"

namespace rangepose::cuda {

/// The 3x3 pixels around (x, y), row by row; outside of the image the border repeats.
template <typename Read>
RP_BODY void readNine(int x, int y, int width, int height, const Read& read, float (&nine)[9]) {
  RP_UNROLL
  for (int i = 0; i < 9; ++i) {
    const int u = x + i % 3 - 1;
    const int v = y + i / 3 - 1;
    nine[i] = read(u < 0        ? 0
                   : u >= width ? width - 1
                                : u,
                   v < 0         ? 0
                   : v >= height ? height - 1
                                 : v);
  }
}

template <typename Read>
RP_BODY float medianPixel(int x, int y, int width, int height, const Read& read) {
  float nine[9];
  readNine(x, y, width, height, read, nine);
  return medianOfNine(nine);
}

template <typename Read>
RP_BODY float edgePixel(int x, int y, int width, int height, const Read& read, float threshold_px) {
  const auto stepAt = [&](int u, int v) {
    float nine[9];
    readNine(u, v, width, height, read, nine);
    return stepOfNine(nine, threshold_px);
  };
  // Most pixels are level, most others jumps: few need their neighbours.
  const float here = stepAt(x, y);
  if (here != kSteep) return here == kJump ? 1.0f : 0.0f;
  float steps[9];
  readNine(x, y, width, height, stepAt, steps);
  return edgeOfSteps(steps);
}

/// A pixel on which nothing was splatted: later than every range, whose bits are ordered like the
/// positive numbers they are.
inline constexpr unsigned int kNoSplat = 0xffffffffU;

/// Splats one measured pixel; `nearer(index, bits)` must keep the smallest value of a pixel,
/// whatever the order of the calls.
template <typename Nearer>
RP_BODY void splatPixel(const ResampleSetup& setup,
                        int u,
                        int v,
                        float depth_mm,
                        int width,
                        int height,
                        const Nearer& nearer) {
  if (depth_mm == 0.0f) return;
  const auto splat = splatOf<float>(setup, static_cast<float>(u), static_cast<float>(v), depth_mm);
  if (!splat.drawn) return;
  unsigned int bits;
  memcpy(&bits, &splat.range, sizeof bits);
  for (int y = splat.y; y < splat.y + splat.count; ++y) {
    if (y < 0 || y >= height) continue;
    for (int x = splat.x; x < splat.x + splat.count; ++x) {
      if (x >= 0 && x < width) nearer(y * width + x, bits);
    }
  }
}

/// Range of a pixel after all splats [px].
RP_BODY float rangeOfSplats(unsigned int bits) {
  float range = 0.0f;
  if (bits != kNoSplat) memcpy(&range, &bits, sizeof range);
  return range;
}

}  // namespace rangepose::cuda
