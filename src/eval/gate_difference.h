// What a change does to the figures of the gate, and how sure that is.
#pragma once

#include <cstddef>
#include <vector>

#include "eval/bootstrap.h"
#include "eval/gate_columns.h"

namespace rangepose {

/// The same images by two systems, in the same order.
struct PairedTallies {
  std::vector<const ImageTally*> before;
  std::vector<const ImageTally*> after;
  std::vector<std::size_t> units;  ///< of each image: 0, 1, ...; images of one unit, such as those
                                   ///< of a bin that is emptied, are drawn together
};

/// Fewer than that all go the same way by chance in more than one of twenty cases.
inline constexpr std::size_t kLeastUnits = 6;

struct FigureDifference {
  const GateColumn* column = nullptr;
  double before = 0.0;
  double after = 0.0;
  Interval interval;      ///< of after - before
  std::size_t units = 0;  ///< that were drawn from
  double change() const { return after - before; }
  bool clear() const { return units >= kLeastUnits && interval.leavesOut(0.0); }
};

struct GateDifference {
  std::vector<FigureDifference> figures;  ///< those of gateColumns() that are compared
  double time_ratio = 0.0;                ///< of the medians, after / before; NaN without times
};

/// Throws Error where the images are not the same ones.
GateDifference gateDifference(const PairedTallies& pairs, const BootstrapOptions& options = {});

}  // namespace rangepose
