// Plots of the paper's experiment: time by stage, success against threshold.
#pragma once

#include <filesystem>
#include <vector>

#include "eval/paper_run.h"

namespace rangepose {

/// times.png (where trials were timed) and success.png in a folder that exists. Each is written
/// whole or not at all.
void writePaperPlots(const std::filesystem::path& folder, const std::vector<SettingRun>& runs);

}  // namespace rangepose
