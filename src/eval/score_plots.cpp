#include <fmt/format.h>

#include "debug/canvas.h"
#include "eval/chart.h"
#include "eval/score_report.h"

namespace rangepose {
namespace {

Chart successChart(const std::vector<ScoreRow>& rows, const PickingOptions& options) {
  Chart chart;
  chart.title = "Success against threshold";
  chart.note = fmt::format("Parts visible >= {:.0f} %", 100.0 * options.min_visible);
  chart.x = {"limit of MSSD [% of the diameter]", 0.0, 20.0};
  chart.y = {"recall [%]", 0.0, 100.0};
  for (const ScoreRow& row : rows) {
    ChartCurve curve{row.name, {}, false};
    for (std::size_t i = 0; i < row.success.size(); ++i) {
      curve.points.emplace_back(100.0 * kSuccessStep * static_cast<double>(i),
                                100.0 * row.success[i]);
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

Chart precisionRecallChart(const std::vector<ScoreRow>& rows, const PickingOptions& options) {
  Chart chart;
  chart.title = "Precision and recall";
  chart.note = fmt::format("Right: MSSD below {:.0f} % of the diameter", 100.0 * options.right);
  chart.x = {"recall [%]", 0.0, 100.0};
  chart.y = {"precision [%]", 0.0, 100.0};
  for (const ScoreRow& row : rows) {
    ChartCurve curve{row.name, {}, false};
    for (const PrecisionRecall& point : row.picking.curve) {
      curve.points.emplace_back(100.0 * point.recall, 100.0 * point.precision);
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

Chart reliabilityChart(const std::vector<ScoreRow>& rows) {
  Chart chart;
  chart.title = "Reliability of the score";
  chart.note = "On the diagonal a score is the share that is right";
  chart.x = {"mean score", 0.0, 1.0};
  chart.y = {"share that is right [%]", 0.0, 100.0};
  chart.diagonal = true;
  for (const ScoreRow& row : rows) {
    ChartCurve curve{row.name, {}, true};
    for (const ReliabilityBin& bin : row.picking.reliability) {
      curve.points.emplace_back(bin.mean_score, 100.0 * bin.right);
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

}  // namespace

void writeScorePlots(const std::filesystem::path& folder,
                     const std::vector<ScoreRow>& rows,
                     const PickingOptions& options) {
  debug::writePng(folder / "success.png", drawChart(successChart(rows, options)));
  debug::writePng(folder / "precision_recall.png", drawChart(precisionRecallChart(rows, options)));
  debug::writePng(folder / "reliability.png", drawChart(reliabilityChart(rows)));
}

}  // namespace rangepose
