#include "pipeline/confidence.h"

#include <algorithm>
#include <cmath>

namespace rangepose {

double logOddsOf(const CheckResult& check, double visible_share) {
  // Where nothing of the outline can be seen it says nothing.
  const double seen = 1.0 - check.outline_covered;
  const double ends = seen > 1e-3 ? (check.outline - 0.5 * check.outline_covered) / seen : 0.5;
  return -33.7 - 7.3 * std::log(check.contradicted + 0.1) - 6.2 * std::log(check.buried + 0.1) +
         10.4 * ends + 3.7 * std::log(visible_share + 0.02) -
         8.0 * std::max(0.0, check.hidden - 0.4);
}

double probabilityOf(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace rangepose
