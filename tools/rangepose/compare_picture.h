// The picture of `rangepose compare`: what each path made of each stage.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "database/reference_database.h"
#include "pipeline/estimate.h"

namespace rangepose::cli {

/// What a path made of the image by itself.
struct SeenPath {
  std::string path;
  Estimate estimate;
  EstimateTrace trace;
  Image<float> surface_mm;  ///< depth of the reference's best pose, rendered by this path
};

SeenPath seeOnPath(StageSet& stages,
                   const DepthImage& depth,
                   const std::optional<BinBox>& bin,
                   const ReferenceDatabase& database,
                   const EstimateOptions& options,
                   const SeenPath* reference);

/// Of the first object; writes a PNG file.
void writeComparison(const std::filesystem::path& file, const std::vector<SeenPath>& paths);

}  // namespace rangepose::cli
