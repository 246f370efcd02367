// Two paths on one depth image, stage by stage: where do they part?
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/estimate.h"

namespace rangepose {

/// One stage on both paths. Values are pixels, error sums, simplexes, hypotheses or poses, whatever
/// the stage makes; the tolerances and their reasons are a table in tally.cpp.
struct StageComparison {
  std::string stage;
  std::string path;              ///< name of the subject, e.g. "glsl"
  std::int64_t differing = 0;    ///< values farther apart than `tolerance`
  std::int64_t total = 0;        ///< values compared
  double max_difference = 0.0;   ///< [unit]
  double mean_difference = 0.0;  ///< over all values [unit]
  std::string unit;              ///< "px", "mm", "deg", "relative" or "" for labels
  double tolerance = 0.0;        ///< how far apart one value may be [unit]; 0: equal
  double allowed_share = 0.0;    ///< share of the values that may be farther apart, 0..1
  bool within = true;
  double reference_ms = 0.0;  ///< time of the reference [ms]
  double path_ms = 0.0;       ///< time of the subject [ms], with upload and download
};

struct Comparison {
  std::string reference;  ///< name of the path that is compared with
  std::string subject;
  /// Each stage of the subject is fed what the reference made, so that differences do not pile up.
  std::vector<StageComparison> isolated;
  /// Each path runs by itself, from the depth image to poses.
  std::vector<StageComparison> chained;
  /// "isolated NAME" or "chained NAME"; nothing when all stages are within tolerance.
  std::optional<std::string> first_out_of_tolerance;
  std::vector<std::string> verdict;  ///< one line each: starts, winning views, poses
  DeviceWork subject_work;           ///< what the subject did on its device meanwhile
  std::string left_to_host;          ///< stages that the subject has not, in words; empty: none
};

/// Throws Error when the image has no measured pixel. The first call on a path includes what it
/// makes once (shaders, packed views); it is made before anything is timed.
Comparison comparePaths(const DepthImage& depth,
                        const std::optional<BinBox>& bin,
                        const ReferenceDatabase& database,
                        const EstimateOptions& options,
                        StageSet& reference,
                        StageSet& subject);

/// Aligned plain text, several lines: the isolated stages, the chained ones, the verdict.
std::string comparisonTable(const Comparison& comparison);

}  // namespace rangepose
