// What of a depth image may be a part: everything but the table, or the bin's floor and walls.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "database/reference_database.h"
#include "geometry/flat_faces.h"

namespace rangepose {

struct ForegroundOptions {
  double part_mm = 100.0;     ///< diameter of the largest part [mm]: a background plane is larger
  PlaneExtent flat_face;      ///< of the parts: no wall is as small
  double tolerance_mm = 2.0;  ///< points this close to a plane belong to it [mm]
  double min_floor_share = 0.04;  ///< of the measured pixels that a floor or table has at least
  double min_wall_share = 0.02;   ///< the same for a wall
  double max_behind =
      0.03;  ///< share of the measured pixels that may lie behind a background plane
  double min_above = 0.001;  ///< share that must stand out of each by three tolerances
  int max_planes = 6;        ///< a floor, four walls, and a table around the bin
};

/// For parts of the database in an image with that depth noise [mm].
ForegroundOptions foregroundOptionsFor(const ReferenceDatabase& database, double noise_mm);

/// Points p with normal * p = offset_mm, in the camera frame; the normal points to the camera's
/// side.
struct BackgroundPlane {
  glm::dvec3 normal{0.0};
  double offset_mm = 0.0;
  double heightOf(const glm::dvec3& point) const { return glm::dot(normal, point) - offset_mm; }
};

/// Large planes with nearly nothing behind them: a table or floor, then walls that stand on it.
/// Repeatable: the random numbers are seeded.
std::vector<BackgroundPlane> findBackground(const DepthImage& image,
                                            const ForegroundOptions& options);

/// 1 where a pixel was measured and lies in front of all planes by more than the tolerance and, if
/// a box is given, inside of the bin (or above it); else 0.
Image<std::uint8_t> foregroundMask(const DepthImage& image,
                                   const std::vector<BackgroundPlane>& planes,
                                   const std::optional<BinBox>& bin,
                                   const ForegroundOptions& options);

}  // namespace rangepose
