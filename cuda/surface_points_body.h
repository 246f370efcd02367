// The points of a rendered surface, picked by one block. Runs on the device and, in tests, on the
// host; see block.h. Same points in the same order as the host's pointsOfSurface, then
// rimOfSurface.
#pragma once

#include "cuda/block.h"
#include "stages/surface_points_core.h"

namespace rangepose::cuda {

/// Shared by the threads of a block; the leader changes it.
template <int kThreads>
struct PickShared {
  int stride;
  int columns;          ///< of the samples
  int samples;          ///< in all; the pixels of the window follow, where a rim is wanted
  int first[kThreads];  ///< place of a thread's first point
  int found[kThreads];  ///< points of a thread
};

/// Each pixel gives a point of a face and one of the rim at most.
RP_HD int mostPoints(const SurfaceWindow& window) { return 2 * window.width * window.height; }

/// A whole number for HostBlock::sum.
struct Seen {
  int texels;
};

/// `surface(x, y)` reads a texel of the window. `points` holds mostPoints(window) at least; the
/// number of points is the answer.
template <typename Block, typename Surface>
RP_BODY void pickPoints(Block& block,
                        PickShared<Block::kThreads>& shared,
                        const Surface& surface,
                        const SurfaceWindow& window,
                        const Camera& camera,
                        const Pose& camera_from_object,
                        int max_points,
                        bool with_rim,
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
  const int all = shared.samples + (with_rim ? window.width * window.height : 0);
  const int each = (all + kThreads - 1) / kThreads;
  const Pose object_from_camera = camera_from_object.inverse();
  const int rim_stride = rimStride(shared.stride);
  /// Calls add(makePoint) for each point.
  const auto forOwnSamples = [&](int thread, const auto& add) {
    const int end = (thread + 1) * each < all ? (thread + 1) * each : all;
    for (int sample = thread * each; sample < end; ++sample) {
      const bool face = sample < shared.samples;
      const int pixel = sample - shared.samples;
      const int x =
          face ? shared.stride / 2 + sample % shared.columns * shared.stride : pixel % window.width;
      const int y =
          face ? shared.stride / 2 + sample / shared.columns * shared.stride : pixel / window.width;
      const SurfaceTexel texel = surface(x, y);
      if (texel.w <= 0.0f) continue;
      if (face) {
        add([&] { return pointOfTexel(texel, camera, window, object_from_camera, x, y); });
        continue;
      }
      if (!isRim(surface, window, x, y, rim_stride)) continue;
      const glm::dvec2 out = outOfSurface(surface, window, x, y);
      if (out == glm::dvec2(0.0)) continue;
      add([&] { return rimOfTexel(texel, out, camera, window, object_from_camera, x, y); });
    }
  };
  block.forEachThread([&](int thread) {
    int found = 0;
    forOwnSamples(thread, [&](const auto&) { ++found; });
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
  block.forEachThread([&](int thread) {
    int next = shared.first[thread];
    forOwnSamples(thread, [&](const auto& makePoint) { points[next++] = makePoint(); });
  });
}

}  // namespace rangepose::cuda
