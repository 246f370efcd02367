// The paper's tables with our figures beside its own.
#pragma once

#include <string>
#include <vector>

#include "eval/paper_run.h"

namespace rangepose {

/// Errors are means over the right poses, as in the paper; NaN without one.
struct GradeSummary {
  int trials = 0;
  int right = 0;
  double vertex_percent = 0.0;  ///< of the bounding box's diagonal
  double rotation_deg = 0.0;    ///< modulo symmetry
  glm::dvec3 euler_deg{0.0};
};

GradeSummary summarize(const std::vector<Trial>& trials, PoseGrade Trial::*grade);

/// Mean times of the trials that were timed [ms], in the order of the pipeline; empty without one.
StageTimes meanTimes(const std::vector<Trial>& trials);

/// The trials of all models.
std::vector<Trial> allTrials(const SettingRun& run);

/// Tables 1 to 5.
std::string paperMarkdown(const std::vector<SettingRun>& runs);

/// A line for each trial.
std::string trialsCsv(const std::vector<SettingRun>& runs);

/// "adaptive 64 px, 1024 views".
std::string settingName(const PaperSetting& setting);

}  // namespace rangepose
