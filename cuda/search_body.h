// The fused search: one block runs the whole simplex of one view in one window (paper Sect. 6.2 and
// 6.3). Runs on the device and, in tests, on the host; see block.h.
#pragma once

#include <cstring>

#include "cuda/block.h"
#include "cuda/search_types.h"

namespace rangepose::cuda {

/// The sums of Eq. 2 that depend on the translation.
struct MovingSums {
  float cover_sum = 0.0f;
  float range_sum = 0.0f;
  float range_weight = 0.0f;
};

/// A thread's pixels of a view in registers: every kThreads-th one, kSlots at most. Slots without a
/// pixel weigh nothing.
template <int kSlots>
class KeptPixels {
 public:
  RP_BODY void load(const ViewPixel* pixels, int count, int thread, int threads, int stride) {
    RP_UNROLL
    for (int slot = 0; slot < kSlots; ++slot) {
      const int index = slot * threads + thread;
      ViewPixel pixel{};
      if (index < count) pixel = pixels[index];
      pixel.place = pixel.place % 65536 + pixel.place / 65536 * stride;
      pixel_[slot] = pixel;
    }
  }
  /// `at(pixel)` for each, until no thread of the block has one left.
  template <typename At>
  RP_BODY void forEach(const ViewPixel*, int count, int, int threads, int, const At& at) const {
    RP_UNROLL
    for (int slot = 0; slot < kSlots; ++slot) {
      if (slot * threads >= count) break;
      at(pixel_[slot]);
    }
  }

 private:
  ViewPixel pixel_[kSlots];  ///< place: in the framed window, relative to the tile's pixel (0, 0)
};

/// For views with more pixels than registers hold: they are read again at each evaluation.
template <>
class KeptPixels<0> {
 public:
  RP_BODY void load(const ViewPixel*, int, int, int, int) {}
  template <typename At>
  RP_BODY void forEach(
      const ViewPixel* pixels, int count, int thread, int threads, int stride, const At& at) const {
    for (int index = thread; index < count; index += threads) {
      ViewPixel pixel = pixels[index];
      pixel.place = pixel.place % 65536 + pixel.place / 65536 * stride;
      at(pixel);
    }
  }
};

/// Shared by the threads of a block; the leader changes it. Aligned for loads of 16 bytes.
struct alignas(16) SearchShared {
  SimplexState state;
};

/// One view in one framed window: evaluates Eq. 2 with all threads.
template <int kSlots, typename Block>
class ViewInWindow {
 public:
  RP_BODY ViewInWindow(Block& block,
                       const SearchSetup& setup,
                       const ViewEntry& view,
                       const ViewPixel* pixels,
                       const WindowTexel* window)
      : block_(block),
        setup_(setup),
        rows_(setup.row_step == 2 ? view.even : view.all),
        pixels_(pixels + view.first),
        window_(window) {
    block_.forEachThread([&](int thread) {
      kept_[thread].load(pixels_, rows_.count, thread, Block::kThreads, setup_.frame.stride());
    });
  }

  /// `then(terms)` is called by the leader; barriers before and after it.
  template <typename Then>
  RP_BODY void evaluate(float x, float y, float z, const Then& then) {
    const float reach = maxShiftPx(setup_.size);
    // Written so that a NaN is outside too.
    const bool reachable = x >= -reach && x <= reach && y >= -reach && y <= reach;
    const int stride = setup_.frame.stride();
    const int column = setup_.frame.origin + (reachable ? wholeShift(x) : 0);
    const int row = setup_.frame.origin + (reachable ? wholeShift(y) : 0);
    const int tile = row * stride + column;
    const float shift_z = z - static_cast<float>(setup_.size);
    typename Block::template PerThread<MovingSums> sums;
    const int count = reachable ? rows_.count : 0;
    block_.forEachThread([&](int thread) {
      MovingSums sum;
      kept_[thread].forEach(
          pixels_, count, thread, Block::kThreads, stride, [&](const ViewPixel& pixel) {
            addPixel(pixel, window_[tile + pixel.place], shift_z, sum);
          });
      sums[thread] = sum;
    });
    block_.template sum<float>(sums, [&](const MovingSums& sum) {
      then(ErrorTerms{
          sum.cover_sum, reachable ? rows_.cover_count : 0.0f, sum.range_sum, sum.range_weight});
    });
  }

 private:
  static RP_BODY int wholeShift(float shift) { return static_cast<int>(std::floor(shift + 0.5f)); }

  RP_BODY void addPixel(const ViewPixel& pixel,
                        const WindowTexel& seen,
                        float shift_z,
                        MovingSums& sum) const {
    const ErrorTerms terms = errorOfPixel(pixel.distance,
                                          pixel.cosine,
                                          pixel.range + shift_z,
                                          seen.distance,
                                          seen.range,
                                          setup_.range);
    sum.cover_sum += terms.cover_sum;
    sum.range_sum += terms.range_sum;
    sum.range_weight += terms.range_weight;
  }

  Block& block_;
  const SearchSetup& setup_;
  const ViewEntry::Rows rows_;
  const ViewPixel* pixels_;
  const WindowTexel* window_;
  typename Block::template PerThread<KeptPixels<kSlots>> kept_;
};

/// The best translation of `view` in a window whose centre has the range `seed_range_px`.
template <int kSlots, typename Block>
RP_BODY void searchView(Block& block,
                        SearchShared& shared,
                        const SearchSetup& setup,
                        const ViewEntry& view,
                        const ViewPixel* pixels,
                        const WindowTexel* window,
                        float seed_range_px,
                        Hypothesis& answer) {
  SimplexState& state = shared.state;
  block.leader([&] {
    const glm::vec3 start = startTranslation(view.anchor_px, setup.size, seed_range_px);
    state = simplexStart(start.x, start.y, start.z, setup.simplex.step_px);
  });
  ViewInWindow<kSlots, Block> pair(block, setup, view, pixels, window);
  const float area = areaFactor(setup.area, view.area_px, setup.max_area_px);
  block.barrier();
  while (state.phase != static_cast<int>(SimplexPhase::kDone)) {
    const SimplexPoint at = state.candidate;
    pair.evaluate(at.x, at.y, at.z, [&](const ErrorTerms& terms) {
      simplexAdvance(state,
                     errorValue(terms, setup.lambda_per_px, area),
                     setup.simplex.spread,
                     setup.simplex.max_iterations);
    });
  }
  block.leader([&] {
    const SimplexPoint& best = state.vertex[state.lowest];
    answer.translation_px = {best.x, best.y, best.z};
    answer.error = best.value;
    answer.iterations = state.iterations;
  });
}

/// The sums of Eq. 2 of a view at one translation.
template <int kSlots, typename Block>
RP_BODY void sumView(Block& block,
                     const SearchSetup& setup,
                     const ViewEntry& view,
                     const ViewPixel* pixels,
                     const WindowTexel* window,
                     const glm::vec3& translation_px,
                     ErrorTerms& answer) {
  ViewInWindow<kSlots, Block> pair(block, setup, view, pixels, window);
  pair.evaluate(translation_px.x, translation_px.y, translation_px.z, [&](const ErrorTerms& terms) {
    answer = terms;
  });
}

/// Texel (x, y) of a framed window; `range(x, y)` and `distance(x, y)` read the window.
template <typename Range, typename Distance>
RP_BODY WindowTexel framedTexel(const WindowFrame& frame,
                                float outside_distance,
                                int x,
                                int y,
                                const Range& range,
                                const Distance& distance) {
  const int u = x - frame.pad;
  const int v = y - frame.pad;
  const bool inside = u >= 0 && v >= 0 && u < frame.width && v < frame.width;
  if (!inside) return {0.0f, outside_distance};
  return {range(u, v), distance(u, v)};
}

}  // namespace rangepose::cuda
