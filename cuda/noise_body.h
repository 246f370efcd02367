// The depth noise of an image: the value in the middle of all second differences digit by digit
// (radix selection), then the mean of what is below it. No order of the differences is kept: the
// counts are the same in any.
#pragma once

#include <cstdint>
#include <cstring>

#include "cuda/block.h"
#include "stages/noise_core.h"

namespace rangepose::cuda {

/// Numbers >= 0 have 31 bits: a digit of 11 bits, then two of 10.
inline constexpr int kNoiseDigits = 3;
inline constexpr int kNoiseBins = 2048;

RP_HD int digitBins(int digit) { return digit == 0 ? kNoiseBins : kNoiseBins / 2; }
RP_HD int digitShift(int digit) { return 10 * (kNoiseDigits - 1 - digit); }

struct NoiseState {
  std::uint32_t count = 0;  ///< differences
  std::uint32_t known = 0;  ///< leading digits of the one in the middle, in the end its bits
  std::uint32_t rank = 0;   ///< of that one among those with the same leading digits, from 0
  std::uint32_t lower = 0;  ///< differences with smaller leading digits
  double noise_mm = 0.0;
};

/// Calls `visit(difference, bits)` for what is a thread's of the rows that are a part's; rows of
/// parts and columns of threads come in turn. `read(u, v)` gives a depth [mm].
template <typename Read, typename Visit>
RP_BODY void visitDifferences(int thread,
                              int threads,
                              int part,
                              int parts,
                              int width,
                              int height,
                              const Read& read,
                              const Visit& visit) {
  for (int v = kNoiseRowStep * part; v < height; v += kNoiseRowStep * parts) {
    for (int u = kNoiseApart + thread; u + kNoiseApart < width; u += threads) {
      const float difference =
          secondDifference(read(u - kNoiseApart, v), read(u, v), read(u + kNoiseApart, v));
      if (!(difference >= 0.0f)) continue;
      std::uint32_t bits;
      memcpy(&bits, &difference, sizeof bits);
      visit(difference, bits);
    }
  }
}

/// Counts a digit of the differences of a part whose leading digits are known. `raise(bin)` adds
/// one to the block's own `bins`, `add(bin, count)` to those of all blocks.
template <typename Block, typename Read, typename Raise, typename Add>
RP_BODY void countDigits(Block& block,
                         std::uint32_t (&bins)[kNoiseBins],
                         const NoiseState& state,
                         int digit,
                         int part,
                         int parts,
                         int width,
                         int height,
                         const Read& read,
                         const Raise& raise,
                         const Add& add) {
  const int count = digitBins(digit);
  const int shift = digitShift(digit);
  const int leading = digitShift(digit - 1);
  block.forEachThread([&](int thread) {
    for (int i = thread; i < count; i += Block::kThreads) bins[i] = 0;
  });
  block.barrier();
  block.forEachThread([&](int thread) {
    visitDifferences(
        thread, Block::kThreads, part, parts, width, height, read, [&](float, std::uint32_t bits) {
          if (digit > 0 && bits >> leading != state.known >> leading) return;
          raise(static_cast<int>(bits >> shift) & (count - 1));
        });
  });
  block.barrier();
  block.forEachThread([&](int thread) {
    for (int i = thread; i < count; i += Block::kThreads) {
      if (bins[i] != 0) add(i, bins[i]);
    }
  });
}

/// Goes down into the digit of the difference in the middle; leaves the counts at 0.
template <typename Block>
RP_BODY void pickDigit(Block& block,
                       std::uint32_t (&sums)[Block::kThreads],
                       NoiseState& state,
                       int digit,
                       std::uint32_t* counts) {
  const int each = digitBins(digit) / Block::kThreads;
  block.forEachThread([&](int thread) {
    sums[thread] = 0;
    for (int i = thread * each; i < (thread + 1) * each; ++i) sums[thread] += counts[i];
  });
  block.barrier();
  block.leader([&] {
    std::uint32_t all = 0;
    for (int i = 0; i < Block::kThreads; ++i) all += sums[i];
    if (digit == 0) {
      state = NoiseState{};
      state.count = all;
      state.rank = all / 2;
    }
    if (all == 0) return;
    std::uint32_t before = 0;
    int bin = 0;
    while (before + sums[bin / each] <= state.rank) {
      before += sums[bin / each];
      bin += each;
    }
    while (before + counts[bin] <= state.rank) before += counts[bin++];
    state.known |= static_cast<std::uint32_t>(bin) << digitShift(digit);
    state.rank -= before;
    state.lower += before;
  });
  block.barrier();
  block.forEachThread([&](int thread) {
    for (int i = thread * each; i < (thread + 1) * each; ++i) counts[i] = 0;
  });
}

/// The sum of the differences of a part that are smaller than the one in the middle.
template <typename Block, typename Read>
RP_BODY void sumLower(Block& block,
                      const NoiseState& state,
                      int part,
                      int parts,
                      int width,
                      int height,
                      const Read& read,
                      double& result) {
  typename Block::template PerThread<double> sums;
  block.forEachThread([&](int thread) {
    double sum = 0.0;
    visitDifferences(thread,
                     Block::kThreads,
                     part,
                     parts,
                     width,
                     height,
                     read,
                     [&](float difference, std::uint32_t bits) {
                       if (bits < state.known) sum += static_cast<double>(difference);
                     });
    sums[thread] = sum;
  });
  block.template sum<double>(sums, [&](double sum) { result = sum; });
}

/// See host::depthNoise, of the sums of all parts.
RP_BODY double noiseOfParts(const NoiseState& state, const double* sums, int parts) {
  if (state.count < kNoiseFewest) return 0.0;
  double sum = 0.0;
  for (int i = 0; i < parts; ++i) sum += sums[i];
  float middle = 0.0f;
  memcpy(&middle, &state.known, sizeof middle);
  // Of those as large as the one in the middle, some are in the lower half.
  const std::uint32_t half = state.count / 2;
  sum += static_cast<double>(half - state.lower) * static_cast<double>(middle);
  return noiseOfLowerHalf(sum, static_cast<double>(half));
}

}  // namespace rangepose::cuda
