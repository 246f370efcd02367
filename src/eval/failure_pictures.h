// A picture and a caption for each trial that went wrong.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/emptying.h"
#include "eval/paper_figures.h"

namespace rangepose {

/// What made a trial fail, as far as its figures tell; one sentence.
std::string likelyCause(const Trial& trial);

class FailurePictures {
 public:
  /// Pictures go into `folder`, which exists.
  explicit FailurePictures(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Draws the trial if its final pose is wrong: the estimate, and the true pose of the nearest
  /// part.
  void add(const PaperSetting& setting,
           const std::string& model,
           const Mesh& mesh,
           const Trial& trial,
           const BinScan& scan,
           const TrialAnswer& answer);

  int count() const { return static_cast<int>(captions_.size()); }
  /// A list of all pictures with their captions.
  std::string markdown() const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> captions_;
};

}  // namespace rangepose
