#include "eval/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/random.h"

namespace rangepose {
namespace {

/// Linear between the sorted values, the first at share 0, the last at 1.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double weight = place - static_cast<double>(below);
  return (1.0 - weight) * sorted[below] + weight * sorted[above];
}

std::vector<std::vector<std::size_t>> drawUnits(std::size_t units,
                                                const BootstrapOptions& options) {
  Random random(options.seed);
  std::vector<std::vector<std::size_t>> draws(static_cast<std::size_t>(options.draws));
  for (std::vector<std::size_t>& draw : draws) {
    for (std::size_t i = 0; i < units; ++i) {
      draw.push_back(static_cast<std::size_t>(random.uniform() * static_cast<double>(units)));
    }
  }
  return draws;
}

}  // namespace

void BootstrapOptions::check() const {
  RP_CHECK(draws >= 1, "bootstrap: draws must be at least 1");
  RP_CHECK(level > 0.0 && level < 1.0, "bootstrap: level must lie between 0 and 1");
}

std::vector<Interval> bootstrapIntervals(std::size_t units,
                                         const FiguresOfDraw& figures,
                                         const BootstrapOptions& options) {
  options.check();
  RP_CHECK(units > 0, "bootstrap: there is nothing to draw from");
  const std::vector<std::vector<std::size_t>> draws = drawUnits(units, options);
  std::vector<std::vector<double>> values(draws.size());
  parallelForEach(draws.size(), 16, [&](std::size_t i) { values[i] = figures(draws[i]); });
  std::vector<Interval> intervals;
  const double tail = 0.5 * (1.0 - options.level);
  for (std::size_t figure = 0; figure < values.front().size(); ++figure) {
    std::vector<double> sorted;
    for (const std::vector<double>& draw : values) {
      if (!std::isnan(draw[figure])) sorted.push_back(draw[figure]);
    }
    std::sort(sorted.begin(), sorted.end());
    intervals.push_back({quantile(sorted, tail), quantile(sorted, 1.0 - tail)});
  }
  return intervals;
}

}  // namespace rangepose
