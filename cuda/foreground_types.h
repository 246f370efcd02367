// What the kernels of the foreground share and what is asked of them.
#pragma once

#include <cstddef>

#include "cuda/noise_body.h"
#include "stages/foreground_core.h"

namespace rangepose::cuda {

inline constexpr int kMostPlanes = 6;
/// Random numbers that a round draws.
inline constexpr int kDrawsOfRound = 3 * kPlaneTrials;

/// Samples, number by number.
struct SampleArrays {
  double* values = nullptr;  ///< 6 * capacity
  int capacity = 0;

  RP_HD SurfaceSample get(int i) const {
    const double* at = values + i;
    const auto next = static_cast<std::size_t>(capacity);
    return {{at[0], at[next], at[2 * next]}, {at[3 * next], at[4 * next], at[5 * next]}};
  }
  RP_HD void set(int i, const SurfaceSample& sample) const {
    double* at = values + i;
    const auto next = static_cast<std::size_t>(capacity);
    for (int k = 0; k < 3; ++k) {
      at[static_cast<std::size_t>(k) * next] = sample.point[k];
      at[static_cast<std::size_t>(k + 3) * next] = sample.normal[k];
    }
  }
};

/// So many samples an image of that size has at most. With a stride of n these are no more than the
/// measured pixels, of which there are fewer than would make the stride n + 1, and no more than the
/// cells of the grid.
inline int mostSamples(int width, int height) {
  const double pixels = static_cast<double>(width) * height;
  double most = 0.0;
  for (int stride = 1; stride <= sampleStride(pixels); ++stride) {
    const double cells = static_cast<double>((width + stride - 1) / stride) *
                         static_cast<double>((height + stride - 1) / stride);
    const double measured = kSamplesWanted * (stride + 1) * (stride + 1);
    const double samples = measured < cells ? measured : cells;
    most = samples > most ? samples : most;
  }
  return static_cast<int>(most);
}

/// What is known of the foreground so far. All zero before the first launch.
struct ForegroundState {
  NoiseState noise;
  int measured = 0;           ///< pixels
  int lost = 0;               ///< pixels that can be filled
  double tolerance_mm = 0.0;  ///< of the planes, at that noise
  double total = 0.0;         ///< samples of the image
  int samples = 0;            ///< that are left
  int side = 0;               ///< which of the two arrays they are in
  int planes = 0;
  int done = 0;                 ///< 1: there is no further plane
  unsigned long long best = 0;  ///< see planeKey(); of the planes of this round
  BackgroundPlane plane[kMostPlanes];
};

/// What is asked.
struct ForegroundRules {
  Camera camera;
  ForegroundOptions options;  ///< tolerance: of thick parts
  double thin_mm = 0.0;       ///< see ForegroundTask
  BinRule bin;
};

inline ForegroundRules rulesFor(const Camera& camera, const ForegroundTask& task) {
  return {camera, task.options, task.thin_mm, binRule(task.bin)};
}

/// Orders planes by their samples, then by how early they were tried. Never 0.
RP_HD unsigned long long planeKey(int samples, int trial) {
  return static_cast<unsigned long long>(samples) << 32 |
         static_cast<unsigned long long>(0xffffffffU - static_cast<unsigned>(trial));
}
RP_HD int trialOf(unsigned long long key) {
  return static_cast<int>(0xffffffffU - static_cast<unsigned>(key & 0xffffffffU));
}

}  // namespace rangepose::cuda
