#include "eval/gate_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace rangepose {

const std::vector<GateColumn>& gateColumns() {
  using F = GateFigures;
  constexpr auto kCount = FigureUnit::kCount;
  constexpr auto kPercent = FigureUnit::kPercent;
  constexpr auto kNumber = FigureUnit::kNumber;
  static const std::vector<GateColumn> columns = {
      {"images", "images", kCount, 0, true, false, [](const F& f) { return 1.0 * f.images; }},
      {"parts", "parts", kCount, 0, true, false, [](const F& f) { return 1.0 * f.parts; }},
      {"first_pick",
       "first pick right [%]",
       kPercent,
       1,
       true,
       true,
       [](const F& f) { return f.first_pick; }},
      {"recall", "recall [%]", kPercent, 1, true, true, [](const F& f) { return f.recall; }},
      {"recall_as_seen",
       "recall as seen [%]",
       kPercent,
       1,
       true,
       false,
       [](const F& f) { return f.recall_as_seen; }},
      {"precision",
       "precision [%]",
       kPercent,
       1,
       true,
       true,
       [](const F& f) { return f.precision; }},
      {"precision_as_seen",
       "precision as seen [%]",
       kPercent,
       1,
       true,
       false,
       [](const F& f) { return f.precision_as_seen; }},
      {"average_precision",
       "AP",
       kNumber,
       3,
       true,
       true,
       [](const F& f) { return f.average_precision; }},
      {"recall_checked",
       "recall, all checked [%]",
       kPercent,
       1,
       true,
       false,
       [](const F& f) { return f.recall_checked; }},
      {"sure", "score > 0.9", kCount, 0, true, false, [](const F& f) { return 1.0 * f.sure; }},
      {"sure_right",
       "right of these [%]",
       kPercent,
       1,
       true,
       true,
       [](const F& f) { return f.sure_right; }},
      {"none_images",
       "images without parts",
       kCount,
       0,
       true,
       false,
       [](const F& f) { return 1.0 * f.none_images; }},
      {"none_poses",
       "poses in such an image",
       kNumber,
       2,
       true,
       false,
       [](const F& f) { return f.none_poses; }},
      {"checked",
       "checked poses",
       kCount,
       0,
       false,
       false,
       [](const F& f) { return 1.0 * f.checked; }},
      {"brier", "Brier score", kNumber, 4, true, true, [](const F& f) { return f.brier; }},
      {"calibration_error",
       "calibration error",
       kNumber,
       4,
       true,
       false,
       [](const F& f) { return f.calibration_error; }},
      {"mean_right",
       "mean score of right poses",
       kNumber,
       3,
       false,
       false,
       [](const F& f) { return f.mean_right; }},
      {"mean_wrong",
       "mean score of wrong poses",
       kNumber,
       3,
       false,
       false,
       [](const F& f) { return f.mean_wrong; }},
      {"median_mssd",
       "median error [% of diameter]",
       kPercent,
       3,
       true,
       true,
       [](const F& f) { return f.median_mssd; }},
      {"time_s",
       "time [s an image]",
       FigureUnit::kSeconds,
       3,
       true,
       false,
       [](const F& f) { return f.time_s; }},
  };
  return columns;
}

const GateColumn& gateColumn(const std::string& key) {
  const std::vector<GateColumn>& columns = gateColumns();
  const auto found = std::find_if(
      columns.begin(), columns.end(), [&](const GateColumn& column) { return key == column.key; });
  if (found == columns.end()) throw Error("there is no figure \"" + key + "\"");
  return *found;
}

std::string figureText(const GateColumn& column, double value, bool sign) {
  if (std::isnan(value)) return "-";
  const double shown = column.unit == FigureUnit::kPercent ? 100.0 * value : value;
  return sign ? fmt::format("{:+.{}f}", shown, column.decimals)
              : fmt::format("{:.{}f}", shown, column.decimals);
}

}  // namespace rangepose
