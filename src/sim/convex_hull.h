// The convex hull of points.
#pragma once

#include <array>
#include <vector>

#include "core/glm.h"

namespace rangepose {

/// All points x inside have dot(normal, x) <= offset.
struct HullPlane {
  glm::dvec3 normal{0.0};  ///< unit vector, outwards
  double offset = 0.0;     ///< [mm]
};

struct ConvexHull {
  std::vector<glm::dvec3> corners;                   ///< [mm]
  std::vector<std::array<glm::dvec3, 3>> triangles;  ///< the surface, facing outwards
  std::vector<HullPlane> planes;                     ///< none when flat
  double volume = 0.0;                               ///< [mm^3]

  /// How far a point lies outside [mm]; 0 or less inside.
  double outside(const glm::dvec3& point) const;
};

ConvexHull convexHull(const std::vector<glm::dvec3>& points);

/// Its volume alone, which is much cheaper [mm^3].
double hullVolume(const std::vector<glm::dvec3>& points);

/// The hull of at most `max_corners` of the corners, chosen one by one as those that lie farthest
/// out, until none lies out by more than `tolerance_mm`.
ConvexHull simplifiedHull(const ConvexHull& hull, int max_corners, double tolerance_mm);

}  // namespace rangepose
