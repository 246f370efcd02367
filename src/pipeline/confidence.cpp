#include "pipeline/confidence.h"

#include <cmath>

namespace rangepose {

double logOddsOf(const CheckResult& check, double visible_share) {
  // Where nothing of the outline can be seen it says nothing.
  const double seen = 1.0 - check.outline_covered;
  const double ends = seen > 1e-3 ? (check.outline - 0.5 * check.outline_covered) / seen : 0.5;
  return -34.4 - 7.3 * std::log(check.contradicted + 0.1) - 6.2 * std::log(check.buried + 0.1) +
         10.4 * ends + 3.7 * std::log(visible_share + 0.02);
}

double probabilityOf(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace rangepose
