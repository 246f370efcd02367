#include "eval/scan_statistics_report.h"

#include <fmt/format.h>

#include <cmath>

namespace rangepose {
namespace {

struct Row {
  std::string figure;  ///< and its unit; "%" is of shares
  double value = 0.0;
  int decimals = 0;
};

constexpr double kPercent = 100.0;

void addErrorRows(const ScanStatistics& set, std::vector<Row>& rows) {
  rows.push_back({"pixels compared", static_cast<double>(set.pixels), 0});
  rows.push_back({"noise between neighbours [mm]", set.noise_mm, 3});
  rows.push_back({"common step of all depth values [mm]", set.common_step_mm, 3});
  rows.push_back({"median gap between depth values [mm]", set.gap_mm, 3});
  rows.push_back({"error: rms [mm]", set.rms_mm, 3});
  rows.push_back({"error: mean size [mm]", set.mean_size_mm, 3});
  rows.push_back(
      {fmt::format("error: rms {} px or more inside [mm]", kDeepPx), set.deep_rms_mm, 3});
  for (std::size_t i = 0; i < kErrorShiftsPx.size(); ++i) {
    rows.push_back({fmt::format("error: differs {} px off by [mm]", kErrorShiftsPx[i]),
                    set.difference_mm[i],
                    3});
  }
  for (std::size_t i = 0; i < kErrorShiftsPx.size(); ++i) {
    rows.push_back(
        {fmt::format("error: correlation {} px off", kErrorShiftsPx[i]), set.correlation[i], 2});
  }
}

void addJumpRows(const ScanStatistics& set, std::vector<Row>& rows) {
  rows.push_back({"jumps: profiles without large holes", static_cast<double>(set.profiles), 0});
  rows.push_back({"jumps: smeared over [px]", set.smear_px, 2});
  rows.push_back({"jumps: half passed at, median [px]", set.passing_px, 2});
  rows.push_back({"jumps: half passed at, spread [px]", set.passing_spread_px, 2});
  for (std::size_t i = 0; i < kProfilePlacesPx.size(); ++i) {
    rows.push_back({fmt::format("jumps: depth {} px outside [% of the jump]", kProfilePlacesPx[i]),
                    kPercent * set.places[i].depth,
                    0});
  }
  for (std::size_t i = 0; i < kProfilePlacesPx.size(); ++i) {
    rows.push_back({fmt::format("jumps: lost {} px outside [%]", kProfilePlacesPx[i]),
                    kPercent * set.places[i].lost,
                    1});
  }
  constexpr const char* kSides[] = {"left", "right", "top", "bottom"};
  for (std::size_t i = 0; i < set.sides.size(); ++i) {
    const JumpSideFigures& side = set.sides[i];
    const std::string name = fmt::format("jumps, {}: ", kSides[i]);
    rows.push_back({name + "profiles", static_cast<double>(side.profiles), 0});
    rows.push_back({name + "half passed at, median [px]", side.passing_px, 2});
    rows.push_back({name + "hole [px]", side.hole_px, 2});
    rows.push_back({name + "hole of 2 px or more [%]", kPercent * side.wide_share, 1});
  }
}

std::vector<Row> rowsOf(const ScanStatistics& set) {
  std::vector<Row> rows;
  addErrorRows(set, rows);
  addJumpRows(set, rows);
  for (std::size_t i = 0; i < set.lost_by_slant.size(); ++i) {
    rows.push_back({fmt::format("lost, slant {} to {} deg [%]", 15 * i, 15 * (i + 1)),
                    kPercent * set.lost_by_slant[i],
                    1});
  }
  rows.push_back({"lost of the silhouettes [%]", kPercent * set.lost_share, 1});
  return rows;
}

std::string cell(const Row& row) {
  if (std::isnan(row.value)) return "-";
  const bool zero = std::abs(row.value) < 0.5 * std::pow(10.0, -row.decimals);  // not "-0"
  return fmt::format("{:.{}f}", zero ? 0.0 : row.value, row.decimals);
}

std::string title(const ScanStatistics& set) {
  return fmt::format("{} ({} images, {} parts)", set.name, set.images, set.parts);
}

constexpr const char* kLegend = R"(
Error: measured less true depth, along z, after the small motion of each part that explains most of
it was taken out; inner pixels that agree with the pose, seen by 60 deg or less. Noise: from second
differences along rows and columns, cut off at three deviations. Differs L px off by: root of half
the mean squared difference of errors. Jumps: profiles across contours of parts with something
measured 15 mm or more behind; smeared: pixels between 15 and 85 % of the jump; half passed at:
positive outside of the true contour, both of profiles with at most two pixels missing; depth:
median, where there is some. Hole: the longest run of pixels without depth at the contour. Lost:
visible inner pixels without depth.
)";

}  // namespace

std::string scanMarkdown(const std::vector<ScanStatistics>& sets) {
  std::string text = "| figure |";
  std::string line = "|---|";
  std::vector<std::vector<Row>> columns;
  for (const ScanStatistics& set : sets) {
    text += fmt::format(" {} |", title(set));
    line += "---|";
    columns.push_back(rowsOf(set));
  }
  text += "\n" + line + "\n";
  for (std::size_t i = 0; !columns.empty() && i < columns.front().size(); ++i) {
    text += fmt::format("| {} |", columns.front()[i].figure);
    for (const std::vector<Row>& column : columns) text += fmt::format(" {} |", cell(column[i]));
    text += "\n";
  }
  return text + kLegend;
}

std::string scanCsv(const std::vector<ScanStatistics>& sets) {
  std::string text = "figure";
  std::vector<std::vector<Row>> columns;
  for (const ScanStatistics& set : sets) {
    text += "," + set.name;
    columns.push_back(rowsOf(set));
    columns.back().insert(columns.back().begin(),
                          {{"images", static_cast<double>(set.images), 0},
                           {"parts", static_cast<double>(set.parts), 0}});
  }
  text += "\n";
  for (std::size_t i = 0; !columns.empty() && i < columns.front().size(); ++i) {
    text += "\"" + columns.front()[i].figure + "\"";
    for (const std::vector<Row>& column : columns) {
      text += std::isnan(column[i].value) ? "," : fmt::format(",{:.6g}", column[i].value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace rangepose
