// The partial mesh of a pose as points with normals: what refinement aligns to the scene (paper
// Sect. 7).
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/kept.h"
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

/// pointsAndRimOfView of the views of an object, by view; empty where they were not asked for.
struct ViewPoints {
  std::vector<std::vector<SurfacePoint>> of;
  std::uint64_t first_name = 1;
  /// Never that of other points in a process, never 0.
  std::uint64_t nameOf(int view) const { return first_name + static_cast<std::uint64_t>(view); }
};

/// Made once: they are the same in every image.
class PointsOfViews {
 public:
  /// Of those views at least.
  std::shared_ptr<const ViewPoints> of(const ReferenceObject& object,
                                       int max_points,
                                       std::vector<int> views);

 private:
  /// By ReferenceObject::serial and number of points, of which there are two.
  Kept<std::pair<std::uint64_t, int>, ViewPoints> kept_{512};
};

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
