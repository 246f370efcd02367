// The stages of the rough search on both paths: error sums, simplex steps, whole searches.
#pragma once

#include <vector>

#include "compare/tally.h"

namespace rangepose {

class SearchComparison {
 public:
  SearchComparison(StageSet& reference, StageSet& subject);

  /// `trace` is that of the reference and has at least one window.
  void compare(const ReferenceObject& object, const ObjectTrace& trace);
  std::vector<StageComparison> results() const;

 private:
  void errorTerms(const ReferenceObject& object, const ObjectTrace& trace, std::size_t window);
  void replaySimplexes(const ReferenceObject& object, const ObjectTrace& trace);
  void search(const ReferenceObject& object, const ObjectTrace& trace);

  StageSet& reference_;
  StageSet& subject_;
  Tally terms_;
  Tally steps_;
  Tally errors_;
  Tally winners_;
};

/// Errors of all hypotheses, and the winners of each window. A winner may be another view where the
/// reference gives both about the same error.
void tallyHypotheses(const std::vector<Hypothesis>& reference,
                     const std::vector<Hypothesis>& subject,
                     Tally& errors,
                     Tally& winners);

/// The hypothesis with the smallest error in a window, null where there is none.
const Hypothesis* winnerOf(const std::vector<Hypothesis>& hypotheses, int window);

}  // namespace rangepose
