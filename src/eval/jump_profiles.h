// What a sensor makes of a jump of depth: measured depth across the outer contours of known parts,
// where what lies behind is farther by kJumpMm or more.
//
// A profile goes along the normal of the contour in the image, in steps of a pixel from 12 px
// inside of it to 16 px outside, each the nearest pixel. The contour itself is known to a fraction
// of a pixel, from the silhouette around it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/camera.h"
#include "eval/known_surface.h"

namespace rangepose {

inline constexpr double kJumpMm = 15.0;
inline constexpr int kProfileInsidePx = 12;
inline constexpr int kProfileOutsidePx = 16;
inline constexpr int kProfileSteps = kProfileInsidePx + kProfileOutsidePx + 1;

enum class ContourSide { kLeft, kRight, kTop, kBottom };  ///< of the part; within 45 degrees

struct JumpProfile {
  int part = -1;
  glm::dvec2 contour_px{0.0};                      ///< where the true contour is passed
  glm::dvec2 outward{0.0};                         ///< unit vector
  std::array<float, kProfileSteps> measured_mm{};  ///< 0: not measured
  std::array<double, kProfileSteps> place_px{};    ///< of the pixel, along the normal
  /// Of the part: the known depth and what the data is off from it 6 to 12 px inside; outside, as
  /// at its rim.
  std::array<double, kProfileSteps> near_mm{};
  /// Of what lies behind: the line through what is measured 8 to 16 px outside (medians of values
  /// and slopes).
  std::array<double, kProfileSteps> far_mm{};

  ContourSide side() const;
  /// Of the jump: 0 where the data is at the part, 1 at what lies behind; NaN where there is none.
  double fraction(int step) const;
};

/// All profiles of an image that count: the part itself was measured inside of the contour, and
/// outside of it, 6 to 14 px off, most pixels were, farther by kJumpMm, with nothing known nearer.
std::vector<JumpProfile> jumpProfiles(const DepthImage& image,
                                      const KnownSurface& known,
                                      const std::vector<KnownPart>& parts);

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
