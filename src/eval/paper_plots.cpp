#include "eval/paper_plots.h"

#include <algorithm>

#include "debug/canvas.h"
#include "eval/chart.h"
#include "eval/paper_tables.h"
#include "eval/stacked_bars.h"

namespace rangepose {
namespace {

constexpr double kSuccessEnd = 20.0;  ///< [% of the diagonal]
constexpr double kSuccessStep = 0.1;

/// Share of the trials with a pose closer than each limit [%].
ChartCurve successCurve(const std::string& name,
                        const std::vector<Trial>& trials,
                        PoseGrade Trial::*grade) {
  ChartCurve curve{name, {}, false};
  const int steps = static_cast<int>(kSuccessEnd / kSuccessStep);
  for (int i = 0; i <= steps; ++i) {
    const double limit = i * kSuccessStep;
    const auto right =
        std::count_if(trials.begin(), trials.end(), [grade, limit](const Trial& trial) {
          const PoseGrade& pose = trial.*grade;
          return pose.part >= 0 && 100.0 * pose.vertex < limit;
        });
    curve.points.emplace_back(
        limit, 100.0 * static_cast<double>(right) / static_cast<double>(trials.size()));
  }
  return curve;
}

Chart successChart(const SettingRun& run) {
  const std::vector<Trial> trials = allTrials(run);
  Chart chart;
  chart.title = "Success against threshold";
  chart.note = settingName(run.setting) + ", " + std::to_string(trials.size()) + " trials";
  chart.x = {"limit of the vertex error [% of the diagonal]", 0.0, kSuccessEnd};
  chart.y = {"right [%]", 0.0, 100.0};
  chart.curves = {successCurve("Eq. 1 alone, no limit", trials, &Trial::unlimited),
                  successCurve("Eq. 1 alone", trials, &Trial::search),
                  successCurve("aligned with its view", trials, &Trial::rough),
                  successCurve("after refinement", trials, &Trial::fine)};
  return chart;
}

StackedBars timeBars(const std::vector<SettingRun>& runs) {
  StackedBars bars;
  bars.title = "Time by stage";
  bars.note = "Mean of every fifth trial";
  bars.unit = "ms";
  for (const SettingRun& run : runs) {
    const StageTimes times = meanTimes(allTrials(run));
    if (times.empty()) continue;
    if (bars.parts.empty()) {
      for (const StageTime& time : times) bars.parts.push_back(time.stage);
    }
    StackedBars::Bar bar{settingName(run.setting), {}};
    bar.values.reserve(bars.parts.size());
    for (const std::string& stage : bars.parts) {
      const auto found = std::find_if(times.begin(), times.end(), [&stage](const StageTime& time) {
        return time.stage == stage;
      });
      bar.values.push_back(found == times.end() ? 0.0 : found->ms);
    }
    bars.bars.push_back(std::move(bar));
  }
  return bars;
}

}  // namespace

void writePaperPlots(const std::filesystem::path& folder, const std::vector<SettingRun>& runs) {
  const StackedBars bars = timeBars(runs);
  if (!bars.bars.empty()) debug::writePng(folder / "times.png", drawStackedBars(bars));
  std::vector<cv::Mat> panels;
  panels.reserve(runs.size());
  for (const SettingRun& run : runs) panels.push_back(drawChart(successChart(run)));
  debug::writePng(folder / "success.png", debug::below(panels));
}

}  // namespace rangepose
