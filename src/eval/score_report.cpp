#include "eval/score_report.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

namespace rangepose {
namespace {

constexpr double kSuccessEnd = 0.2;

std::string percent(double share, int decimals = 1) {
  return std::isnan(share) ? "-" : fmt::format("{:.{}f}", 100.0 * share, decimals);
}

std::string plain(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

ScoreRow rowOf(const std::string& name,
               const GradedResults& results,
               const PickingOptions& options,
               const std::optional<int>& obj_id) {
  ScoreRow row{
      name, bopScores(results.images, obj_id), pickingScores(results.images, options, obj_id), {}};
  const int steps = static_cast<int>(std::lround(kSuccessEnd / kSuccessStep));
  for (int i = 0; i <= steps; ++i) {
    // No pose is right at a limit of 0.
    row.success.push_back(
        i == 0 ? 0.0 : recallAt(results.images, i * kSuccessStep, options.min_visible, obj_id));
  }
  return row;
}

std::string pickingTable(const std::vector<ScoreRow>& rows, const PickingOptions& options) {
  const std::string strict = percent(options.strict, 0);
  std::string text = fmt::format(
      "| object | images | first pick [%] | first pick at {0} % [%] | parts | recall [%] | "
      "recall at {0} % [%] | estimates | precision [%] | AP | recall at 99 % precision [%] | "
      "median MSSD [% of diameter] | median rotation [deg] | median translation [mm] | "
      "recall as seen [%] | precision as seen [%] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      strict);
  for (const ScoreRow& row : rows) {
    const PickingScores& p = row.picking;
    fmt::format_to(
        std::back_inserter(text),
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
        row.name,
        p.images,
        percent(p.first_pick),
        percent(p.first_pick_strict),
        p.parts,
        percent(p.recall),
        percent(p.recall_strict),
        p.estimates,
        percent(p.precision),
        plain(p.average_precision, 3),
        percent(p.recall_at_99),
        percent(p.median_mssd, 3),
        plain(degrees(p.median_rotation_rad), 3),
        plain(p.median_translation_mm, 3),
        percent(p.recall_as_seen),
        percent(p.precision_as_seen));
  }
  return text;
}

std::string bopTable(const std::vector<ScoreRow>& rows) {
  std::string text =
      "| object | targets | AR | AR VSD | AR MSSD | AR MSPD |\n|---|---|---|---|---|---|\n";
  for (const ScoreRow& row : rows) {
    fmt::format_to(std::back_inserter(text),
                   "| {} | {} | {} | {} | {} | {} |\n",
                   row.name,
                   row.bop.targets,
                   plain(row.bop.average(), 3),
                   plain(row.bop.vsd, 3),
                   plain(row.bop.mssd, 3),
                   plain(row.bop.mspd, 3));
  }
  return text;
}

std::string reliabilityTable(const ScoreRow& all) {
  std::string text = "| score | estimates | mean score | right [%] |\n|---|---|---|---|\n";
  for (const ReliabilityBin& bin : all.picking.reliability) {
    fmt::format_to(std::back_inserter(text),
                   "| {:.1f} to {:.1f} | {} | {} | {} |\n",
                   bin.low,
                   bin.high,
                   bin.count,
                   plain(bin.mean_score, 3),
                   percent(bin.right));
  }
  return text;
}

std::string cell(double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value); }

}  // namespace

std::vector<ScoreRow> scoreRows(const GradedResults& results, const PickingOptions& options) {
  std::vector<ScoreRow> rows{rowOf("all", results, options, std::nullopt)};
  if (results.objects.size() < 2) return rows;
  for (const GradedObject& object : results.objects) {
    rows.push_back(
        rowOf(fmt::format("{} {}", object.obj_id, object.name), results, options, object.obj_id));
  }
  return rows;
}

std::string scoreMarkdown(const GradedResults& results,
                          const std::vector<ScoreRow>& rows,
                          const PickingOptions& options) {
  std::string text =
      fmt::format("{} images, {} estimates", results.image_count, rows.front().picking.estimates);
  if (!std::isnan(results.mean_time_s)) {
    text += fmt::format(", {:.3f} s an image on average", results.mean_time_s);
  }
  text += fmt::format(
      ".\n\n### Bin picking\n\nRight: MSSD below {} % of the diameter. Parts: those visible >= {} "
      "%. "
      "A right pose of a less visible part ({} of them) counts neither as found nor as false; a "
      "second one of the same part is false. As seen: a pose is also right that looks like "
      "the true one, so that at most {} % of what is visible of them is {} % of the diameter "
      "apart, or "
      "more.\n\n",
      percent(options.right, 0),
      percent(options.min_visible, 0),
      rows.front().picking.ignored,
      percent(options.unlike),
      percent(kLookApart, 0));
  text += pickingTable(rows, options);
  text += "\n### BOP\n\nAverage recalls as in the BOP challenges since 2019.\n\n" + bopTable(rows);
  text += "\n### Reliability\n\n";
  text += rows.front().picking.reliability.empty()
              ? std::string("Some scores lie outside of 0..1: no table.\n")
              : reliabilityTable(rows.front());
  return text;
}

std::string scoreCsv(const std::vector<ScoreRow>& rows) {
  std::string text =
      "object,images,first_pick,first_pick_strict,parts,recall,recall_strict,estimates,ignored,"
      "precision,average_precision,recall_at_99,median_mssd,median_rotation_deg,"
      "median_translation_mm,recall_as_seen,precision_as_seen,targets,ar,ar_vsd,ar_mssd,ar_mspd\n";
  for (const ScoreRow& row : rows) {
    const PickingScores& p = row.picking;
    fmt::format_to(std::back_inserter(text),
                   "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                   row.name,
                   p.images,
                   cell(p.first_pick),
                   cell(p.first_pick_strict),
                   p.parts,
                   cell(p.recall),
                   cell(p.recall_strict),
                   p.estimates,
                   p.ignored,
                   cell(p.precision),
                   cell(p.average_precision),
                   cell(p.recall_at_99),
                   cell(p.median_mssd),
                   cell(degrees(p.median_rotation_rad)),
                   cell(p.median_translation_mm),
                   cell(p.recall_as_seen),
                   cell(p.precision_as_seen),
                   row.bop.targets,
                   cell(row.bop.average()),
                   cell(row.bop.vsd),
                   cell(row.bop.mssd),
                   cell(row.bop.mspd));
  }
  return text;
}

}  // namespace rangepose
