#include <algorithm>
#include <array>
#include <cstdio>

#include "compare/compare.h"

namespace rangepose {
namespace {

constexpr std::size_t kColumns = 9;
using Cells = std::array<std::string, kColumns>;

std::string number(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// "2e-04 px, 5 %": what one value may differ by, and how many may differ by more.
std::string allowed(const StageComparison& stage) {
  std::string text = stage.tolerance == 0.0 ? "equal" : number("%.2g", stage.tolerance);
  if (stage.tolerance != 0.0 && !stage.unit.empty()) text += " " + stage.unit;
  if (stage.allowed_share > 0.0) text += ", " + number("%g", 100.0 * stage.allowed_share) + " %";
  return text;
}

Cells cellsOf(const StageComparison& stage) {
  return {stage.stage,
          std::to_string(stage.differing),
          std::to_string(stage.total),
          number("%.3g", stage.max_difference),
          number("%.3g", stage.mean_difference),
          allowed(stage),
          stage.total == 0 ? "-"
          : stage.within   ? "ok"
                           : "OUT",
          number("%.2f", stage.reference_ms),
          number("%.2f", stage.path_ms)};
}

/// Text to the left, numbers to the right, two blanks between columns; an empty line before
/// `second_part`.
std::string aligned(const std::vector<Cells>& rows, std::size_t second_part) {
  std::array<std::size_t, kColumns> widths{};
  for (const Cells& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (r == second_part) text += '\n';
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::string& cell = rows[r][i];
      const std::string blanks(widths[i] - cell.size(), ' ');
      const bool left = i == 0 || i == 5 || i == 6;
      if (i > 0) text += "  ";
      text += left ? cell : blanks;
      text += left ? blanks : cell;
    }
    text += '\n';
  }
  return text;
}

void addRows(std::vector<Cells>& rows,
             const std::string& title,
             const Comparison& comparison,
             const std::vector<StageComparison>& stages) {
  rows.push_back({title,
                  "differ",
                  "of",
                  "max",
                  "mean",
                  "allowed",
                  "",
                  comparison.reference + " ms",
                  comparison.subject + " ms"});
  for (const StageComparison& stage : stages) rows.push_back(cellsOf(stage));
}

}  // namespace

std::string comparisonTable(const Comparison& comparison) {
  std::vector<Cells> rows;
  addRows(rows, "isolated", comparison, comparison.isolated);
  const std::size_t second_part = rows.size();
  addRows(rows, "chained", comparison, comparison.chained);
  std::string text = aligned(rows, second_part);
  text += '\n';
  for (const std::string& verdict : comparison.verdict) text += verdict + '\n';
  const DeviceWork& work = comparison.subject_work;
  text += comparison.subject + " made " + std::to_string(work.draws) + " draws and " +
          std::to_string(work.launches) + " kernel launches\n";
  if (!comparison.left_to_host.empty())
    text += comparison.subject + " leaves to the host: " + comparison.left_to_host + '\n';
  return text;
}

}  // namespace rangepose
