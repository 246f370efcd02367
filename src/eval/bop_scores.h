// The scores of the BOP challenges since 2019 for 6D localisation: average recalls (Hodan et al.,
// "BOP Challenge 2020 on 6D Object Localization", ECCVW 2020, Sect. 2.4).
#pragma once

#include <optional>
#include <vector>

#include "eval/matching.h"

namespace rangepose {

/// Each is the mean, over the thresholds of correctness, of the share of the targets that are
/// found; NaN without a target. Only as many estimates as there are targets count in an image,
/// those with the highest scores.
struct BopScores {
  double vsd = 0.0;   ///< AR over misalignments (taus) and thresholds 0.05 .. 0.5
  double mssd = 0.0;  ///< AR over thresholds 0.05 .. 0.5 of the diameter
  double mspd = 0.0;  ///< AR over thresholds 5 .. 50 px in an image 640 px wide
  int targets = 0;
  double average() const { return (vsd + mssd + mspd) / 3.0; }  ///< the AR of the leaderboards
};

/// Of one object, or of all.
BopScores bopScores(const std::vector<ObjectErrors>& images,
                    const std::optional<int>& obj_id = std::nullopt);

}  // namespace rangepose
