// What a sensor makes of a jump of depth: measured depth across the outer contours of known parts,
// where what lies behind is farther by kJumpMm or more.
//
// A profile goes along the normal of the contour in the image, in steps of a pixel from 12 px
// inside of it to 16 px outside, each the nearest pixel. The contour itself is known to a fraction
// of a pixel, from the silhouette around it.
#pragma once

#include <array>
#include <vector>

#include "core/camera.h"
#include "eval/known_surface.h"

namespace rangepose {

inline constexpr double kJumpMm = 15.0;
inline constexpr int kProfileInsidePx = 12;
inline constexpr int kProfileOutsidePx = 16;
inline constexpr int kProfileSteps = kProfileInsidePx + kProfileOutsidePx + 1;
/// The depths on both sides of a jump are taken from what is measured outside of these places, what
/// becomes of the jump is seen between them [px].
inline constexpr int kNearLevelPx = -6;
inline constexpr int kFarLevelPx = 8;

/// The step of a profile at a place [px].
constexpr int profileStepAt(int place_px) { return place_px + kProfileInsidePx; }

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

}  // namespace rangepose
