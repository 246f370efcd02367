#include "eval/jump_tally.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace rangepose {
namespace {

constexpr double kSmearLow = 0.15;
constexpr double kSmearHigh = 0.85;
constexpr int kWideHolePx = 2;
/// A hole belongs to a jump when it touches this stretch [px].
constexpr int kHoleFromPx = -4;
constexpr int kHoleToPx = 6;
/// A profile says where the jump is when so many of the 13 pixels between the levels have depth.
constexpr int kLeastBetween = 11;

/// Where half of the jump is passed first, seen from inside; nothing where a hole hides the place.
std::optional<double> passingPx(const JumpProfile& profile) {
  int inside = -1;
  for (int step = profileStepAt(kNearLevelPx); step <= profileStepAt(kFarLevelPx); ++step) {
    const double fraction = profile.fraction(step);
    if (std::isnan(fraction)) continue;
    if (fraction < 0.5) {
      inside = step;
      continue;
    }
    constexpr int kLargestGap = 2;
    if (inside < 0 || step - inside > kLargestGap) return {};
    const double before = profile.fraction(inside);
    const double from = profile.place_px[static_cast<std::size_t>(inside)];
    const double to = profile.place_px[static_cast<std::size_t>(step)];
    return from + (0.5 - before) / (fraction - before) * (to - from);
  }
  return {};
}

void tallySmear(const JumpProfile& profile, JumpTally& tally) {
  int measured = 0;
  int smeared = 0;
  for (int step = profileStepAt(kNearLevelPx) + 1; step < profileStepAt(kFarLevelPx); ++step) {
    const double fraction = profile.fraction(step);
    measured += std::isnan(fraction) ? 0 : 1;
    smeared += fraction > kSmearLow && fraction < kSmearHigh ? 1 : 0;
  }
  if (measured < kLeastBetween) return;
  const std::optional<double> passing = passingPx(profile);
  if (!passing) return;
  ++tally.profiles;
  tally.smeared_px += smeared;
  tally.sides[static_cast<std::size_t>(profile.side())].passing_px.push_back(
      static_cast<float>(*passing));
}

/// The longest run without depth of those that touch the contour's surroundings [px].
int holePx(const JumpProfile& profile) {
  int longest = 0;
  int begin = 0;
  for (int step = 0; step <= kProfileSteps; ++step) {
    const bool missing =
        step < kProfileSteps && profile.measured_mm[static_cast<std::size_t>(step)] == 0.0f;
    if (missing) continue;
    if (begin <= profileStepAt(kHoleToPx) && step - 1 >= profileStepAt(kHoleFromPx)) {
      longest = std::max(longest, step - begin);
    }
    begin = step + 1;
  }
  return longest;
}

}  // namespace

void JumpTally::add(const JumpTally& other) {
  const auto append = [](std::vector<float>& all, const std::vector<float>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  profiles += other.profiles;
  smeared_px += other.smeared_px;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    sides[side].profiles += other.sides[side].profiles;
    sides[side].hole_px += other.sides[side].hole_px;
    sides[side].wide_holes += other.sides[side].wide_holes;
    append(sides[side].passing_px, other.sides[side].passing_px);
  }
  for (std::size_t i = 0; i < fractions.size(); ++i) append(fractions[i], other.fractions[i]);
}

JumpTally tallyJumps(const std::vector<JumpProfile>& profiles) {
  JumpTally tally;
  for (const JumpProfile& profile : profiles) {
    tallySmear(profile, tally);
    SideTally& side = tally.sides[static_cast<std::size_t>(profile.side())];
    const int hole = holePx(profile);
    ++side.profiles;
    side.hole_px += hole;
    side.wide_holes += hole >= kWideHolePx ? 1 : 0;
    for (std::size_t i = 0; i < kProfilePlacesPx.size(); ++i) {
      const double fraction = profile.fraction(profileStepAt(kProfilePlacesPx[i]));
      if (!std::isnan(fraction)) tally.fractions[i].push_back(static_cast<float>(fraction));
    }
  }
  return tally;
}

}  // namespace rangepose
