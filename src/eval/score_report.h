// The scores of a result file as tables and pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/bop_scores.h"
#include "eval/grade_bop.h"
#include "eval/picking_scores.h"

namespace rangepose {

/// A row of the tables: one object, or all.
struct ScoreRow {
  std::string name;
  BopScores bop;
  PickingScores picking;
  /// Recall against the limit of MSSD, x [diameters] in steps up to 0.2.
  std::vector<double> success;
};

inline constexpr double kSuccessStep = 0.005;  ///< of ScoreRow::success [diameters]

/// All objects together first, then, if there are several, each of them.
std::vector<ScoreRow> scoreRows(const GradedResults& results, const PickingOptions& options);

/// Tables of the bin-picking figures, of BOP's, and of reliability, with a line on how they count.
std::string scoreMarkdown(const GradedResults& results,
                          const std::vector<ScoreRow>& rows,
                          const PickingOptions& options);

/// One line a row; shares are 0..1, empty where there is nothing to count.
std::string scoreCsv(const std::vector<ScoreRow>& rows);

/// success.png, precision_recall.png and reliability.png in a folder that exists. Each is written
/// whole or not at all.
void writeScorePlots(const std::filesystem::path& folder,
                     const std::vector<ScoreRow>& rows,
                     const PickingOptions& options);

}  // namespace rangepose
