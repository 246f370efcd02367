// How sure a checked pose is.
#pragma once

#include "stages/check_core.h"

namespace rangepose {

/// Log odds that a pose is right, from its check against the full image. `visible_share` is the
/// surface that the pose explains as a share of what the object shows on average, 0 to about 2;
/// `outside` the share of its surface that lies where no part can be (enclosure.h).
double logOddsOf(const CheckResult& check, double visible_share, double outside);

/// The probability of those odds, 0..1.
double probabilityOf(double log_odds);

}  // namespace rangepose
