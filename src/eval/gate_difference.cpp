#include "eval/gate_difference.h"

#include <algorithm>

#include "core/error.h"

namespace rangepose {
namespace {

std::vector<const GateColumn*> comparedColumns() {
  std::vector<const GateColumn*> columns;
  for (const GateColumn& column : gateColumns()) {
    if (column.compared) columns.push_back(&column);
  }
  return columns;
}

/// The images of each unit.
std::vector<std::vector<std::size_t>> imagesOfUnits(const PairedTallies& pairs) {
  std::vector<std::vector<std::size_t>> units;
  for (std::size_t i = 0; i < pairs.units.size(); ++i) {
    if (pairs.units[i] >= units.size()) units.resize(pairs.units[i] + 1);
    units[pairs.units[i]].push_back(i);
  }
  return units;
}

void check(const PairedTallies& pairs) {
  RP_CHECK(!pairs.before.empty() && pairs.before.size() == pairs.after.size() &&
               pairs.before.size() == pairs.units.size(),
           "difference: the same images of both systems are needed");
  for (std::size_t i = 0; i < pairs.before.size(); ++i) {
    RP_CHECK(pairs.before[i]->id == pairs.after[i]->id, "difference: the images do not pair");
  }
}

}  // namespace

GateDifference gateDifference(const PairedTallies& pairs, const BootstrapOptions& options) {
  check(pairs);
  const std::vector<const GateColumn*> columns = comparedColumns();
  const std::vector<std::vector<std::size_t>> units = imagesOfUnits(pairs);
  const auto changes = [&](const std::vector<std::size_t>& drawn) {
    std::vector<const ImageTally*> before;
    std::vector<const ImageTally*> after;
    for (const std::size_t unit : drawn) {
      for (const std::size_t image : units[unit]) {
        before.push_back(pairs.before[image]);
        after.push_back(pairs.after[image]);
      }
    }
    const GateFigures of_before = gateFigures(before);
    const GateFigures of_after = gateFigures(after);
    std::vector<double> values;
    values.reserve(columns.size());
    for (const GateColumn* column : columns) {
      values.push_back(column->value(of_after) - column->value(of_before));
    }
    return values;
  };
  const std::vector<Interval> intervals = bootstrapIntervals(units.size(), changes, options);
  const GateFigures before = gateFigures(pairs.before);
  const GateFigures after = gateFigures(pairs.after);
  GateDifference difference;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    difference.figures.push_back({columns[i],
                                  columns[i]->value(before),
                                  columns[i]->value(after),
                                  intervals[i],
                                  units.size()});
  }
  difference.time_ratio = after.time_s / before.time_s;
  return difference;
}

}  // namespace rangepose
