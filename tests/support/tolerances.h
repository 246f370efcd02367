// How far two paths, or a path and a formula, may differ. One place, each with its unit and reason.
#pragma once

namespace rangepose::test {

/// Error sums [relative]: each path adds the same few thousand floats in another order.
inline constexpr float kErrorSumRelative = 1.0e-4f;
/// Sums of a handful of pixels [px]: where all of them cancel out, a relative bound says nothing.
inline constexpr float kErrorSumPx = 1.0e-3f;
/// Error of the best hypothesis of a search [relative]: one ulp in a value may turn a branch of the
/// simplex, which then stops at another point within the 2 % spread that it stops at.
inline constexpr float kBestErrorRelative = 0.02f;
/// Share of single hypotheses whose simplex may have taken another branch, see above.
inline constexpr float kTurnedShare = 0.05f;
/// Rounding of a coordinate in units in the last place: division and square root are correctly
/// rounded on the host and on software rasterisers; GLSL allows 2.5 ulp for a division.
inline constexpr int kDeviceUlps = 4;

/// Farthest corner of an aligned part between two orders of the same sums in floats [mm]: a
/// millionth of a part of 60 mm, or of a step.
inline constexpr double kAlignedMm = 2.0e-4;
/// The same with points of surfaces that two rasterisers made [mm]: they differ at borders, and a
/// few points find other partners.
inline constexpr double kAlignedSurfaceMm = 0.5;
/// Shares, scores and residuals [mm] of a verdict: sums of a few thousand doubles in another order.
inline constexpr double kVerdict = 1.0e-12;
/// The same on points: sums of a few hundred floats in another order.
inline constexpr double kPointVerdict = 1.0e-6;

/// Depth of a rendered face [mm] at 500-700 mm: GL interpolates in float and moves corners to 1/256
/// px.
inline constexpr float kSurfaceDepthMm = 0.05f;
/// Component of a unit normal: one rotation in float instead of double.
inline constexpr float kSurfaceNormal = 1.0e-4f;
/// Share of pixels that two rasterisers may give to different triangles, all on borders of
/// triangles.
inline constexpr float kBorderShare = 0.02f;

/// Position of a border on the raster [px]: GL moves corners to a grid of 1/256 px, and the crease
/// between two steep faces by that times their slope.
inline constexpr double kRasterPx = 0.05;
/// Share of the pixels of references that two rasterisers give to the object or to background, or
/// make edges, not alike: outlines that pass a pixel's centre within 1/256 px, some 50 px long in
/// views of 1000 px. Measured: 0.0001 and 0.0002.
inline constexpr double kReferenceOutlineShare = 0.0005;
/// The same where ranges differ by more than kReferenceRangePx: creases within 1/256 px.
inline constexpr double kReferenceCreaseShare = 0.001;
/// Range of a reference pixel against a formula [px], on faces of slope 4 or less (see kRasterPx).
inline constexpr float kReferenceRangePx = 0.02f;
/// Cosine of a flat face against a formula: float instead of double.
inline constexpr float kReferenceCosine = 1.0e-5f;

}  // namespace rangepose::test
