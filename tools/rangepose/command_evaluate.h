// `rangepose evaluate`: what its three uses share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "eval/picking_scores.h"
#include "eval/virtual_bin.h"
#include "pipeline/estimate.h"

namespace rangepose::cli {

struct EvaluateBopArguments {
  std::string folder;
  std::string csv;
  std::string split = "test";
  PickingOptions picking;
};

struct EvaluatePaperArguments {
  std::string models;
  int bins = 9;
  std::vector<std::string> sampling = {"uniform", "adaptive"};
  std::vector<int> sizes = {32, 64};
  std::vector<int> views = {1024, 2048};
  std::uint64_t seed = 1000;
  std::string camera = "orthographic";
  std::string sensor = "none";
  BinScanOptions scan;
  EstimateOptions estimate;
  std::string path = "host";
  int statistics_bins = 0;  ///< as ViewRequest::bins
  bool contact_sheet = false;
  bool ablation = false;
};

struct EvaluateScansArguments {
  std::vector<std::string> folders;
  std::vector<std::string> truths;  ///< none, or one for each folder; "-" is the folder's own
  std::string split = "test";
};

/// A result file against the truth of a data set. Returns the exit code.
int evaluateBop(const EvaluateBopArguments& arguments, const std::string& out);

/// The paper's experiment. Returns the exit code.
int evaluatePaper(const EvaluatePaperArguments& arguments, const std::string& out);

/// Throws UsageError.
void checkScansUsage(const EvaluateScansArguments& arguments);

/// What the sensor did to surfaces of known pose. Returns the exit code.
int evaluateScans(const EvaluateScansArguments& arguments, const std::string& out);

/// Makes the folder for tables and pictures where it does not exist; throws Error where it cannot
/// be made or written to. Does nothing for an empty name.
void makeOutputFolder(const std::filesystem::path& folder);

}  // namespace rangepose::cli
