// What a sensor does to surfaces, measured on depth images with known poses, so that simulated
// scans can be put beside real ones.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/jump_tally.h"
#include "eval/lost_pixels.h"
#include "eval/surface_errors.h"
#include "io/bop.h"

namespace rangepose {

/// Sums over images. Images may be tallied by any thread; added in their own order, the sums are
/// the same.
struct ScanTally {
  int images = 0;
  int parts = 0;  ///< counted ones
  SurfaceErrorTally errors;
  JumpTally jumps;
  LostTally lost;
  DepthSteps steps;

  void add(const ScanTally& other);
};

ScanTally tallyScan(const DepthImage& image, const std::vector<KnownPart>& parts);

/// Of the profiles across jumps of depth on one side of the parts.
struct JumpSideFigures {
  long long profiles = 0;
  double passing_px = 0.0;  ///< as ScanStatistics::passing_px
  double hole_px = 0.0;     ///< mean run of pixels without depth at the contour
  double wide_share = 0.0;  ///< of profiles with a run of 2 px or more, 0..1
};

/// Of the profiles at one place along them.
struct JumpPlaceFigures {
  double depth = 0.0;  ///< median, from 0 at the part to 1 at what lies behind, where measured
  double lost = 0.0;   ///< share without depth, 0..1
};

/// The figures of a data set; NaN where nothing was there to measure.
struct ScanStatistics {
  std::string name;
  int images = 0;
  int parts = 0;
  long long pixels = 0;  ///< inner ones that agree with the pose and are seen by 60 deg or less

  /// Deviation of the noise between neighbouring pixels, from second differences of e [mm]: see
  /// noiseBetweenNeighbours().
  double noise_mm = 0.0;
  double common_step_mm = 0.0;  ///< 95 % of all depth values are multiples of it
  double gap_mm = 0.0;          ///< median gap between neighbours among the values that occur

  /// e is measured minus known depth, less the small motion of the part that explains most of it.
  double rms_mm = 0.0;        ///< of e
  double mean_size_mm = 0.0;  ///< of e
  double deep_rms_mm = 0.0;   ///< of e, kDeepPx or more inside of contours and jumps
  /// D(L) = sqrt(mean of 0.5 (e(p) - e(p+L))^2), for each of kErrorShiftsPx, pairs along rows and
  /// columns on the same part [mm].
  std::array<double, kErrorShiftsPx.size()> difference_mm{};
  /// 1 - D(L)^2 / variance, where the variance is that of the pairs' pixels; -1..1.
  std::array<double, kErrorShiftsPx.size()> correlation{};

  long long profiles = 0;   ///< across jumps of depth, without large holes; the next are of these
  double smear_px = 0.0;    ///< mean number of steps between 15 and 85 % of the jump
  double passing_px = 0.0;  ///< median place of half the jump; positive: the part looks larger
  double passing_spread_px = 0.0;  ///< half of what lies between 16 and 84 % of these places

  std::array<JumpSideFigures, 4> sides;  ///< by ContourSide, of all profiles
  /// Of all profiles, at each of kProfilePlacesPx from the true contour.
  std::array<JumpPlaceFigures, kProfilePlacesPx.size()> places;

  /// Of inner pixels that are not hidden, those without depth, by slant in steps of 15 deg; 0..1.
  std::array<double, 6> lost_by_slant{};
  double lost_share = 0.0;  ///< the same of all pixels of the parts' silhouettes
};

ScanStatistics statisticsOf(const ScanTally& tally);

/// A data set and its truth.
struct ScanSet {
  std::filesystem::path folder;
  std::string split = "test";
  /// In the format of scene_gt.json; else each scene has its own.
  std::optional<std::filesystem::path> truth = std::nullopt;
};

/// Measures all images with known poses; parts that scene_gt_info.json gives as less than half
/// visible only hide others. Throws Error when there is none, or when one truth is given for a set
/// of several scenes.
ScanStatistics measureScans(const ScanSet& set);

}  // namespace rangepose
