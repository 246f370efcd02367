// `rangepose estimate` over all images of a split of a BOP data set.
#pragma once

#include <string>

#include "pipeline/estimate.h"

namespace rangepose::cli {

struct BopArguments {
  std::string folder;
  std::string split = "test";
  std::string csv;
  bool resume = false;  ///< goes on with a run that was interrupted
};

/// Writes the CSV with what was found in the images that could be read; the others are named on
/// stderr. Until then results are kept image by image (bop_journal.h). `database` was read from
/// `database_file`. Returns the exit code: kFailed when there is an image that could not be read.
int runBop(const BopArguments& arguments,
           const std::string& database_file,
           const ReferenceDatabase& database,
           const EstimateOptions& options,
           StageSet& stages);

}  // namespace rangepose::cli
