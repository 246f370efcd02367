// The points of a rendered surface, picked by one block. Runs on the device and, in tests, on the
// host; see block.h. Same points in the same order as pointsOfSurface of the host.
#pragma once

#include "cuda/block.h"
#include "stages/surface_points_core.h"

namespace rangepose::cuda {

/// Shared by the threads of a block; the leader changes it.
template <int kThreads>
struct PickShared {
  int stride;
  int columns;          ///< of the samples
  int samples;          ///< in all
  int first[kThreads];  ///< place of a thread's first point
  int found[kThreads];  ///< points of a thread
};

/// A whole number for HostBlock::sum.
struct Seen {
  int texels;
};

/// `surface(x, y)` reads a texel of the window. `points` holds window.width * window.height at
/// least; the number of points is the answer.
template <typename Block, typename Surface>
RP_BODY void pickPoints(Block& block,
                        PickShared<Block::kThreads>& shared,
                        const Surface& surface,
                        const SurfaceWindow& window,
                        const Camera& camera,
                        const Pose& camera_from_object,
                        int max_points,
                        SurfacePoint* points,
                        int& answer) {
  constexpr int kThreads = Block::kThreads;
  typename Block::template PerThread<Seen> seen;
  block.forEachThread([&](int thread) {
    Seen own{0};
    for (int i = thread; i < window.width * window.height; i += kThreads) {
      if (surface(i % window.width, i / window.width).w > 0.0f) ++own.texels;
    }
    seen[thread] = own;
  });
  block.template sum<int>(seen, [&](const Seen& all) {
    const int stride = pointStride(static_cast<float>(all.texels), max_points);
    // Samples begin at stride / 2.
    const auto along = [&](int pixels) {
      return pixels > stride / 2 ? (pixels - stride / 2 + stride - 1) / stride : 0;
    };
    shared.stride = stride;
    shared.columns = along(window.width);
    shared.samples = shared.columns * along(window.height);
  });
  // Each thread has samples in a row, so that its points lie behind those of the thread before.
  const int each = (shared.samples + kThreads - 1) / kThreads;
  const auto forOwnSamples = [&](int thread, const auto& at) {
    const int end = (thread + 1) * each < shared.samples ? (thread + 1) * each : shared.samples;
    for (int sample = thread * each; sample < end; ++sample) {
      const int x = shared.stride / 2 + sample % shared.columns * shared.stride;
      const int y = shared.stride / 2 + sample / shared.columns * shared.stride;
      const SurfaceTexel texel = surface(x, y);
      if (texel.w > 0.0f) at(texel, x, y);
    }
  };
  block.forEachThread([&](int thread) {
    int found = 0;
    forOwnSamples(thread, [&](const SurfaceTexel&, int, int) { ++found; });
    shared.found[thread] = found;
  });
  block.barrier();
  block.leader([&] {
    int next = 0;
    for (int thread = 0; thread < kThreads; ++thread) {
      shared.first[thread] = next;
      next += shared.found[thread];
    }
    answer = next;
  });
  block.barrier();
  const Pose object_from_camera = camera_from_object.inverse();
  block.forEachThread([&](int thread) {
    int next = shared.first[thread];
    forOwnSamples(thread, [&](const SurfaceTexel& texel, int x, int y) {
      points[next++] = pointOfTexel(texel, camera, window, object_from_camera, x, y);
    });
  });
}

}  // namespace rangepose::cuda
