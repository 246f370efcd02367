// Figures of profiles across jumps of depth: how wide a jump is smeared, where it is passed, and
// the holes beside it.
#pragma once

#include <array>
#include <vector>

#include "eval/jump_profiles.h"

namespace rangepose {

/// Where along the profiles depth itself is told [px].
inline constexpr std::array<int, 9> kProfilePlacesPx = {-6, -4, -2, -1, 0, 1, 2, 4, 6};

/// Of the profiles on one side of the parts.
struct SideTally {
  long long profiles = 0;
  long long hole_px = 0;     ///< the longest run of pixels without depth that is at the contour
  long long wide_holes = 0;  ///< profiles where that is 2 px or longer
  std::vector<float> passing_px;  ///< of profiles with few holes: where half of the jump is passed
};

struct JumpTally {
  long long profiles = 0;          ///< with few holes: the next is of these
  long long smeared_px = 0;        ///< steps that are between 15 and 85 % of the jump
  std::array<SideTally, 4> sides;  ///< by ContourSide
  /// What JumpProfile::fraction() gives at each of kProfilePlacesPx, where there is depth.
  std::array<std::vector<float>, kProfilePlacesPx.size()> fractions;

  void add(const JumpTally& other);
};

JumpTally tallyJumps(const std::vector<JumpProfile>& profiles);

}  // namespace rangepose
