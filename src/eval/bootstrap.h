// How far figures of a few images may be off by chance: the bootstrap (Efron and Tibshirani, "An
// Introduction to the Bootstrap", 1993, Sect. 13.3, percentile intervals).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace rangepose {

/// NaN where nothing could be counted in any draw.
struct Interval {
  double low = 0.0;
  double high = 0.0;
  bool leavesOut(double value) const { return value < low || value > high; }
};

struct BootstrapOptions {
  int draws = 1000;
  double level = 0.95;  ///< share of the draws inside of the interval
  std::uint64_t seed = 1;
  void check() const;  ///< throws Error naming the bad field
};

/// Figures of drawn units, each an index below the number of units, in any order; the same index
/// may come several times. Always the same number of figures. For the difference of two systems the
/// function measures both on the same draw. It is called from several threads.
using FiguresOfDraw = std::function<std::vector<double>(const std::vector<std::size_t>& drawn)>;

/// An interval for each figure: `draws` times `units` units are drawn with replacement. Figures
/// that are NaN in a draw leave it out. The same for any number of threads.
std::vector<Interval> bootstrapIntervals(std::size_t units,
                                         const FiguresOfDraw& figures,
                                         const BootstrapOptions& options = {});

}  // namespace rangepose
