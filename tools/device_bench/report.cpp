#include "device_bench/report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace rangepose::device_bench {
namespace {

std::string text(double value, int digits) {
  std::ostringstream out;
  out << std::setprecision(digits) << value;
  return out.str();
}

std::string scaled(double value, const char* unit) {
  if (value <= 0.0) return "";
  for (const auto& [size, prefix] :
       {std::pair(1e9, "G"), std::pair(1e6, "M"), std::pair(1e3, "k")}) {
    if (value >= size) return text(value / size, 3) + " " + prefix + unit;
  }
  return text(value, 3) + " " + unit;
}

/// What was done in the time, as a share of what could have been.
std::string share(double amount, double ms, double ceiling_per_s) {
  if (amount <= 0.0 || ceiling_per_s <= 0.0 || ms <= 0.0) return "";
  return text(100.0 * amount / (ms / 1000.0) / ceiling_per_s, 2) + " %";
}

double at(const std::vector<double>& sorted, double quantile) {
  return sorted[static_cast<std::size_t>(
      std::lround(quantile * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

double wallMs(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

Row timed(const std::string& what,
          const std::string& path,
          int runs,
          const std::function<double()>& once) {
  constexpr int kUntimed = 2;
  constexpr std::size_t kFewest = 3;
  constexpr double kBudgetMs = 2000.0;
  for (int i = 0; i < kUntimed; ++i) static_cast<void>(once());
  std::vector<double> times;
  double spent_ms = 0.0;
  while (times.size() < kFewest ||
         (static_cast<int>(times.size()) < runs && spent_ms < kBudgetMs)) {
    spent_ms += wallMs([&] { times.push_back(once()); });
  }
  std::sort(times.begin(), times.end());
  Row row;
  row.what = what;
  row.path = path;
  row.median_ms = at(times, 0.5);
  row.low_ms = at(times, 0.1);
  row.high_ms = at(times, 0.9);
  row.runs = static_cast<int>(times.size());
  return row;
}

std::string markdownTable(const std::vector<Row>& rows, const Ceilings& ceilings) {
  std::string table =
      "| what | path | median [ms] | 10 % to 90 % [ms] | runs | bytes | operations | of the "
      "bandwidth | of the arithmetic |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const Ceilings own = row.on_gpu ? ceilings : Ceilings{};
    table += "| " + row.what + " | " + row.path + " | " + text(row.median_ms, 4) + " | " +
             text(row.low_ms, 4) + " to " + text(row.high_ms, 4) + " | " +
             std::to_string(row.runs) + " | " + scaled(row.work.bytes, "B") + " | " +
             scaled(row.work.operations, "") + " | " +
             share(row.work.bytes, row.median_ms, own.bytes_per_s) + " | " +
             share(row.work.operations, row.median_ms, own.operations_per_s) + " |\n";
  }
  return table;
}

}  // namespace rangepose::device_bench
