// The answer of `rangepose estimate` as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "debug/overlay.h"
#include "pipeline/estimate.h"
#include "pipeline/picking.h"

namespace rangepose::cli {

struct ReportContext {
  const ReferenceDatabase& database;
  std::string path;   ///< that the stages took, e.g. "host"
  std::string image;  ///< file of the scene
  double min_score = 0.0;
  std::vector<Pick> picks;  ///< one a pose, in the same order
  std::size_t found = 0;    ///< poses before those out of reach were left out
};

/// A header, a line for each pose, the times.
std::string textReport(const Estimate& estimate, const ReportContext& context);

/// All numbers in full precision. Throws Error rather than writing one that is not finite.
nlohmann::ordered_json jsonReport(const Estimate& estimate, const ReportContext& context);

/// JSON text; bytes that are not UTF-8 (of file names) are replaced.
std::string jsonText(const nlohmann::ordered_json& json);

/// {"stage": ms, ...}
nlohmann::ordered_json timesJson(const StageTimes& times);

/// A line for each pose; `rough` takes the poses before refinement.
std::vector<debug::OverlayPose> overlayPoses(const Estimate& estimate,
                                             const ReferenceDatabase& database,
                                             bool rough = false);

}  // namespace rangepose::cli
