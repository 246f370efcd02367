#include "eval/gate_tables.h"

#include <fmt/format.h>

#include <cmath>

namespace rangepose {
namespace {

std::string ruleOf(std::size_t columns) {
  std::string rule = "|";
  for (std::size_t i = 0; i < columns; ++i) rule += "---|";
  rule += "\n";
  return rule;
}

std::string plain(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string changeText(const FigureDifference& figure) {
  if (std::isnan(figure.change())) return "-";
  const auto text = [&](double value) { return figureText(*figure.column, value, true); };
  return fmt::format("{} ({} to {}){}",
                     text(figure.change()),
                     text(figure.interval.low),
                     text(figure.interval.high),
                     figure.clear() ? " *" : "");
}

}  // namespace

std::string gateMarkdown(const std::vector<GateRow>& rows) {
  std::string text = "| sensor | bins | part | system |";
  std::size_t columns = 4;
  for (const GateColumn& column : gateColumns()) {
    if (!column.in_table) continue;
    text += fmt::format(" {} |", column.title);
    ++columns;
  }
  text += "\n";
  text += ruleOf(columns);
  for (const GateRow& row : rows) {
    text += fmt::format("| {} | {} | {} | {} |", row.sensor, row.kind, row.part, row.system);
    for (const GateColumn& column : gateColumns()) {
      if (!column.in_table) continue;
      text += fmt::format(" {} |", figureText(column, column.value(row.figures)));
    }
    text += "\n";
  }
  return text;
}

std::string calibrationMarkdown(const std::vector<GateRow>& rows) {
  std::string text = "| sensor | system | score | poses | mean score | right [%] |\n" + ruleOf(6);
  for (const GateRow& row : rows) {
    if (row.kind != kAllKinds || !row.part.empty()) continue;
    for (const ReliabilityBin& bin : row.figures.reliability) {
      text += fmt::format("| {} | {} | {:.1f} to {:.1f} | {} | {} | {} |\n",
                          row.sensor,
                          row.system,
                          bin.low,
                          bin.high,
                          bin.count,
                          plain(bin.mean_score, 3),
                          plain(100.0 * bin.right, 1));
    }
  }
  return text;
}

std::string differenceMarkdown(const std::vector<GateDifferenceRow>& rows) {
  std::string text = "| sensor | bins |";
  std::size_t columns = 3;
  for (const GateColumn& column : gateColumns()) {
    if (!column.compared) continue;
    text += fmt::format(" {} |", column.title);
    ++columns;
  }
  text += " time ratio |\n" + ruleOf(columns);
  for (const GateDifferenceRow& row : rows) {
    text += fmt::format("| {} | {} |", row.sensor, row.kind);
    for (const FigureDifference& figure : row.difference.figures) {
      text += fmt::format(" {} |", changeText(figure));
    }
    text += fmt::format(" {} |\n", plain(row.difference.time_ratio, 2));
  }
  return text;
}

std::string gateCsv(const std::vector<GateRow>& rows) {
  std::string text = "sensor,kind,part,system";
  for (const GateColumn& column : gateColumns()) text += fmt::format(",{}", column.key);
  text += "\n";
  for (const GateRow& row : rows) {
    text += fmt::format("{},{},{},{}", row.sensor, row.kind, row.part, row.system);
    for (const GateColumn& column : gateColumns()) {
      const double value = column.value(row.figures);
      text += std::isnan(value) ? "," : fmt::format(",{:.6g}", value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace rangepose
