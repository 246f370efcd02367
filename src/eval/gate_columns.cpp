#include "eval/gate_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"

namespace rangepose {

namespace {

using F = GateFigures;

template <auto Member>
double valueOf(const F& figures) {
  return static_cast<double>(figures.*Member);
}

// Whether shares, decimals, where shown, and whether compared.
constexpr bool kShare = true;
constexpr bool kInTable = true;
constexpr bool kCompared = true;

constexpr GateColumn kColumns[] = {
    {"images", "images", !kShare, 0, kInTable, !kCompared, valueOf<&F::images>},
    {"parts", "parts", !kShare, 0, kInTable, !kCompared, valueOf<&F::parts>},
    {"first_pick", "first pick right [%]", kShare, 1, kInTable, kCompared, valueOf<&F::first_pick>},
    {"recall", "recall [%]", kShare, 1, kInTable, kCompared, valueOf<&F::recall>},
    {"recall_as_seen",
     "recall as seen [%]",
     kShare,
     1,
     kInTable,
     !kCompared,
     valueOf<&F::recall_as_seen>},
    {"precision", "precision [%]", kShare, 1, kInTable, kCompared, valueOf<&F::precision>},
    {"precision_as_seen",
     "precision as seen [%]",
     kShare,
     1,
     kInTable,
     !kCompared,
     valueOf<&F::precision_as_seen>},
    {"average_precision", "AP", !kShare, 3, kInTable, kCompared, valueOf<&F::average_precision>},
    {"recall_checked",
     "recall, all checked [%]",
     kShare,
     1,
     kInTable,
     !kCompared,
     valueOf<&F::recall_checked>},
    {"sure", "score > 0.9", !kShare, 0, kInTable, !kCompared, valueOf<&F::sure>},
    {"sure_right", "right of these [%]", kShare, 1, kInTable, kCompared, valueOf<&F::sure_right>},
    {"none_images",
     "images without parts",
     !kShare,
     0,
     kInTable,
     !kCompared,
     valueOf<&F::none_images>},
    {"none_poses",
     "poses in such an image",
     !kShare,
     2,
     kInTable,
     !kCompared,
     valueOf<&F::none_poses>},
    {"checked", "checked poses", !kShare, 0, !kInTable, !kCompared, valueOf<&F::checked>},
    {"brier", "Brier score", !kShare, 4, kInTable, kCompared, valueOf<&F::brier>},
    {"calibration_error",
     "calibration error",
     !kShare,
     4,
     kInTable,
     !kCompared,
     valueOf<&F::calibration_error>},
    {"mean_right",
     "mean score of right poses",
     !kShare,
     3,
     !kInTable,
     !kCompared,
     valueOf<&F::mean_right>},
    {"mean_wrong",
     "mean score of wrong poses",
     !kShare,
     3,
     !kInTable,
     !kCompared,
     valueOf<&F::mean_wrong>},
    {"median_mssd",
     "median error [% of diameter]",
     kShare,
     3,
     kInTable,
     kCompared,
     valueOf<&F::median_mssd>},
    {"time_s", "time [s an image]", !kShare, 3, kInTable, !kCompared, valueOf<&F::time_s>},
};

}  // namespace

const std::vector<GateColumn>& gateColumns() {
  static const std::vector<GateColumn> columns(std::begin(kColumns), std::end(kColumns));
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
  const double shown = column.share ? 100.0 * value : value;
  return sign ? fmt::format("{:+.{}f}", shown, column.decimals)
              : fmt::format("{:.{}f}", shown, column.decimals);
}

}  // namespace rangepose
