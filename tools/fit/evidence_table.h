// Checked poses with what is known of them: what the weights of the evidence are fitted to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/evidence.h"

namespace rangepose::fit {

/// A pose that the choice could take.
struct EvidenceRow {
  std::string sensor;
  std::string kind;  ///< of bins
  int scene = 0;
  int image = 0;
  int object = 0;       ///< id
  bool right = false;   ///< MSSD below 10 % of the diameter, or it looks like the true pose
  bool chosen = false;  ///< at the end, by the weights of that time
  double score = 0.0;   ///< of a chosen pose: what users see; else as judged by itself
  double inner_px = 0.0;
  EvidenceTerms terms{};
};

/// CSV with a head.
std::string tableText(const std::vector<EvidenceRow>& rows);

/// Throws Error, naming file and line, for what tableText() has not made.
std::vector<EvidenceRow> readTable(const std::filesystem::path& path);

}  // namespace rangepose::fit
