#include "eval/matching.h"

#include <algorithm>
#include <numeric>

namespace rangepose {

std::vector<int> matchGreedily(const PairErrors& errors,
                               double threshold,
                               const std::vector<bool>& eligible,
                               int max_estimates) {
  std::vector<int> matches(static_cast<std::size_t>(errors.height()), kUnmatched);
  std::vector<bool> free = eligible;
  if (free.empty()) free.assign(static_cast<std::size_t>(errors.width()), true);
  RP_CHECK(static_cast<int>(free.size()) == errors.width(),
           "matching: flags of eligible poses do not fit the table of errors");
  const int rows = max_estimates > 0 ? std::min(max_estimates, errors.height()) : errors.height();
  for (int row = 0; row < rows; ++row) {
    int best = kUnmatched;
    double best_error = threshold;
    for (int column = 0; column < errors.width(); ++column) {
      if (!free[static_cast<std::size_t>(column)] || !(errors.at(column, row) < best_error))
        continue;
      best = column;
      best_error = errors.at(column, row);
    }
    matches[static_cast<std::size_t>(row)] = best;
    if (best != kUnmatched) free[static_cast<std::size_t>(best)] = false;
  }
  return matches;
}

std::vector<bool> largest(const std::vector<double>& values, int count) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&values](std::size_t a, std::size_t b) {
    return values[a] > values[b];
  });
  order.resize(std::min(order.size(), static_cast<std::size_t>(std::max(0, count))));
  std::vector<bool> flags(values.size(), false);
  for (const std::size_t index : order) flags[index] = true;
  return flags;
}

}  // namespace rangepose
