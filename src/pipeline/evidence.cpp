#include "pipeline/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rangepose {
namespace {

// Shares below these are not told apart: a pixel here and there.
constexpr double kLittleThrough = 0.03;
constexpr double kLittleSeen = 0.02;
constexpr double kLittleVisible = 0.02;
constexpr double kObservationPx = 9.0;
constexpr double kDoubt = 4.0;  // observations that may be chance

}  // namespace

const char* nameOf(EvidenceTerm term) {
  constexpr std::array<const char*, kEvidenceTerms> kNames{"one",
                                                           "seen_through",
                                                           "buried",
                                                           "relief",
                                                           "more_relief",
                                                           "unseen_relief",
                                                           "ends",
                                                           "visible",
                                                           "outside"};
  return kNames[static_cast<std::size_t>(term)];
}

EvidenceTerms evidenceTerms(const CheckResult& check, const EvidenceContext& context) {
  const double known = 1.0 - check.outline_covered;
  // Where nothing is known of the outline, half of it.
  const double ends = known > 1e-3 ? (check.outline - 0.5 * check.outline_covered) / known : 0.5;
  const double area_mm2 =
      check.explained > 0.0 ? check.explained_mm2 * (check.explained + check.weak) / check.explained
                            : 0.0;
  const double visible = std::min(area_mm2 / context.mean_visible_mm2, 1.0);
  return {1.0,
          std::log(check.seen_through + kLittleThrough),
          buriedTerm(check),
          std::min(check.relief, kEnoughRelief),
          std::max(check.relief - kEnoughRelief, 0.0),
          std::max(check.whole_relief - std::max(check.relief, 0.0), 0.0),
          ends,
          std::log(visible + kLittleVisible),
          context.outside};
}

double buriedTerm(const CheckResult& check) {
  return check.buried / (check.explained + check.weak + check.buried + kLittleSeen);
}

const EvidenceTerms& evidenceWeights() {
  static constexpr EvidenceTerms kWeights{
      -10.973, -2.754, -3.751, 2.799, 0.052, -1.319, 3.087, 0.551, -177.893};
  return kWeights;
}

double logOddsOf(const EvidenceTerms& terms, double inner_px) {
  const double sum = std::inner_product(terms.begin(), terms.end(), evidenceWeights().begin(), 0.0);
  const double observations = inner_px / kObservationPx;
  if (!(observations > 0.0)) return -std::numeric_limits<double>::infinity();
  return std::min(sum, std::log(observations / kDoubt));
}

double probabilityOf(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace rangepose
