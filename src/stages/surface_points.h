// The partial mesh of a pose as points with normals: what refinement aligns to the scene (paper
// Sect. 7).
#pragma once

#include <vector>

#include "core/camera.h"
#include "stages/reference.h"
#include "stages/surface.h"

namespace rangepose {

struct SurfacePoint {
  glm::vec3 position_mm;  ///< in the object's frame
  glm::vec3 normal;       ///< unit, towards the viewer, in the object's frame
};

/// Points of a database view, from its pixels that are not edges; normals from the differences of
/// neighbouring ranges. Needs no rendering: for the first steps. At most about `max_points`, evenly
/// spread.
std::vector<SurfacePoint> pointsOfView(const ReferenceObject& object, int view, int max_points);

/// Points of a surface rendered at `camera_from_object`. At most about `max_points`, evenly spread.
std::vector<SurfacePoint> pointsOfSurface(const Image<SurfaceTexel>& surface,
                                          const Camera& camera,
                                          const SurfaceWindow& window,
                                          const Pose& camera_from_object,
                                          int max_points);

}  // namespace rangepose
