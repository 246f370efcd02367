// `rangepose estimate` over all images of a split of a BOP data set.
#pragma once

#include <string>

#include "pipeline/estimate.h"

namespace rangepose::cli {

struct BopArguments {
  std::string folder;
  std::string split = "test";
  std::string csv;
};

/// Writes the CSV with what was found in the images that could be read; the others are named on
/// stderr. Returns the exit code: kFailed when there is one of those.
int runBop(const BopArguments& arguments,
           const ReferenceDatabase& database,
           const EstimateOptions& options,
           StageSet& stages);

}  // namespace rangepose::cli
