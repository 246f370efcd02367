#include "pipeline/confidence.h"

#include <algorithm>
#include <cmath>

namespace rangepose {

// The weights follow logistic regressions on checked poses of simulated bins: the parts of models/
// and of models/tuning, sheets flat and bent, boxes, slabs, rods and trays, alone and in heaps,
// with sensor and rough noise, and each searched for among the others; of those poses that nothing
// else in their image explains better. What such bins hardly show is set so that it does no harm
// there: flat faces on flat ground, slivers, poses outside of the bin, and sensors that blur jumps
// of depth, for which these count half of what the bins say.
double logOddsOf(const CheckResult& check, double visible_share, double outside) {
  const double seen = 1.0 - check.outline_covered;
  const double ends = seen > 1e-3 ? (check.outline - 0.5 * check.outline_covered) / seen : 0.5;
  // A flat face can be laid on any face: only where it ends tells whether it belongs there. The
  // mean of a seen half cylinder's unit normals is pi / 4 = 0.79 long: it is not flat.
  const double flat = std::max(0.0, check.flat - 0.8) / 0.2;
  const double goes_on = std::max(0.0, 0.9 - ends) * seen;
  // Of what is mostly hidden or not measured, the rest fits many things.
  const double unseen = check.hidden + check.missing;
  return -16.9 - 4.2 * std::log(check.contradicted + 0.1) - 3.5 * std::log(check.buried + 0.1) +
         5.9 * ends + 5.7 * (ends - 0.8) * seen +
         2.1 * std::log(std::min(visible_share, 1.0) + 0.02) -
         flat * (1.1 * check.outline_covered + 34.0 * goes_on) - 4.6 * std::max(0.0, unseen - 0.4) +
         std::log(check.stability + 0.01) + 1.6 * check.jumps_met -
         1.5 * std::sqrt(check.jumps_missed) - 60.0 * std::max(0.0, 0.1 - visible_share) -
         60.0 * outside;
}

double probabilityOf(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace rangepose
