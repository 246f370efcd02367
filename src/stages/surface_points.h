// The partial mesh of a pose as points with normals: what refinement aligns to the scene (paper
// Sect. 7).
#pragma once

#include <vector>

#include "core/camera.h"
#include "stages/reference.h"
#include "stages/surface.h"

namespace rangepose {

/// A point of a surface as a viewer sees it, in the object's frame.
struct SurfacePoint {
  glm::vec3 position_mm;
  glm::vec3 normal;  ///< unit, towards the viewer; of a rim see there
  /// Whether what is seen of the object ends here. Then `normal` is the unit tangent of the surface
  /// that leads out of it, straight across its rim for the viewer.
  bool rim = false;
};

/// Points of a database view, from its pixels that are not edges; normals from the differences of
/// neighbouring ranges. Needs no rendering: for the first steps. At most about `max_points`, evenly
/// spread.
std::vector<SurfacePoint> pointsOfView(const ReferenceObject& object, int view, int max_points);

/// Points of the rim of a database view: its outline, holes included. About two thirds as dense
/// along it as those of pointsOfView.
std::vector<SurfacePoint> rimOfView(const ReferenceObject& object, int view, int max_points);

/// pointsOfView and rimOfView in one.
std::vector<SurfacePoint> pointsAndRimOfView(const ReferenceObject& object,
                                             int view,
                                             int max_points);

/// Points of a surface rendered at `camera_from_object`. At most about `max_points`, evenly spread.
std::vector<SurfacePoint> pointsOfSurface(const Image<SurfaceTexel>& surface,
                                          const Camera& camera,
                                          const SurfaceWindow& window,
                                          const Pose& camera_from_object,
                                          int max_points);

/// Points of its rim, about two thirds as dense along it as those of pointsOfSurface.
std::vector<SurfacePoint> rimOfSurface(const Image<SurfaceTexel>& surface,
                                       const Camera& camera,
                                       const SurfaceWindow& window,
                                       const Pose& camera_from_object,
                                       int max_points);

}  // namespace rangepose
