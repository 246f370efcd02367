// What of a depth image may be a part: everything but the table, or the bin's floor and walls.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/camera.h"
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
  int max_planes = 6;        ///< a floor, four walls, and a table around the bin; at most 6
};

/// Points p with normal * p = offset_mm, in the camera frame; the normal points to the camera's
/// side.
struct BackgroundPlane {
  glm::dvec3 normal{0.0};
  double offset_mm = 0.0;
  RP_HD double heightOf(const glm::dvec3& point) const {
    return glm::dot(normal, point) - offset_mm;
  }
};

/// What a foreground is wanted for.
struct ForegroundTask {
  ForegroundOptions options;  ///< its tolerance is the largest, for thick parts
  double thin_mm = 0.0;       ///< the tolerance that the thinnest part asks for [mm]
  std::optional<BinBox> bin;

  /// A thin part must not go with the table that it lies on, as far as the noise allows.
  ForegroundOptions optionsAt(double noise_mm) const;
};

/// A depth image made ready for the search.
struct Foreground {
  DepthImage depth;       ///< lost pixels filled
  double noise_mm = 0.0;  ///< depth noise of the image as it came [mm]
  std::vector<BackgroundPlane> background;
  Image<std::uint8_t> mask;  ///< 1: may be a part
};

/// Smallest box around points, of their x and y in the camera frame [mm].
struct LateralExtent {
  glm::dvec2 low{std::numeric_limits<double>::max()};
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
  bool empty() const { return low.x > high.x; }
  void add(const glm::dvec2& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

}  // namespace rangepose
