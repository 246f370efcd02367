// What the alignment and the verdict on a pose are given.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh.h"
#include "stages/check_host.h"
#include "stages/icp_host.h"
#include "stages/surface.h"
#include "stages/surface_points.h"

namespace rangepose {

/// A pose to be aligned with the depth image without background; contract in icp_host.h.
struct AlignTask {
  const std::vector<SurfacePoint>* points = nullptr;
  Pose start;  ///< camera_from_object
  glm::dvec3 center_mm{0.0};
  double radius_mm = 0.0;
  IcpOptions options;
  /// ViewPoints::nameOf: points of that name never change, so a path may keep a copy on its device.
  /// 0: they may.
  std::uint64_t name = 0;
};

/// Points of a posed object to be judged by the whole depth image; contract in check_host.h.
struct JudgeTask {
  const std::vector<SurfacePoint>* points = nullptr;
  Pose camera_from_object;
  double visible_mm2 = 0.0;  ///< area that the points stand for [mm^2]
  CheckOptions options;
  std::uint64_t name = 0;  ///< see AlignTask
};

/// A posed object whose rendered surface is aligned with the depth image without background, or
/// judged by the whole of it. Fields of the other use are ignored.
struct RenderTask {
  const Mesh* mesh = nullptr;
  Pose camera_from_object;
  SurfaceWindow window;       ///< of the rendering; of the depth image's camera
  int max_points = 0;         ///< alignment: >= 1, as in pointsOfSurface and rimOfSurface
  glm::dvec3 center_mm{0.0};  ///< of the sphere around the object, in its frame
  double radius_mm = 0.0;     ///< of that sphere
  IcpOptions alignment;
  CheckOptions check;
  /// That sphere in the camera frame.
  Sphere sphere() const { return {camera_from_object * center_mm, radius_mm}; }
};

}  // namespace rangepose
