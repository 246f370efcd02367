#include "pipeline/align_options.h"

#include "core/error.h"

namespace rangepose {

void AlignOptions::check() const {
  for (const CoarseRound& round : {all, many, few}) {
    RP_CHECK(round.iterations > 0 && round.search_steps >= 0 && round.rim_steps > 0,
             "align: a coarse round needs iterations and steps");
    RP_CHECK(round.first_reach > 0.0 && round.last_tolerances > 0.0 && round.judged > 0.0,
             "align: the reach of a coarse round must be above 0");
  }
  for (const FineRounds& fine : {rest, tie}) {
    RP_CHECK(fine.rounds >= 0 && fine.points > 0 && fine.first_reach > 0.0 &&
                 fine.last_reach > 0.0 && fine.rim_reach >= 0.0,
             "align: fine rounds need points and a reach above 0");
  }
  RP_CHECK(view_points > 0 && settle_px > 0, "align: view_points and settle_px must be above 0");
  RP_CHECK(fine_iterations > 0 && settle_iterations > 0 && settle_rounds >= 0,
           "align: iterations must be above 0, rounds not below");
  RP_CHECK(
      first_reach > 0.0 && later_reach > 0.0 && held > 0.0 && tie_still >= 0.0 && worse >= 0.0,
      "align: first_reach, later_reach and held must be above 0, tie_still and worse not below");
}

}  // namespace rangepose
