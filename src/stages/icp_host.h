// Refinement: the partial mesh of a pose is aligned to the depth image (paper Sect. 7).
#pragma once

#include <vector>

#include "core/camera.h"
#include "stages/icp_core.h"
#include "stages/surface_points.h"

namespace rangepose {

/// What the reach is multiplied with from one iteration to the next.
double icpShrink(const IcpOptions& options);

namespace host {

/// Projective association: a model point looks for the nearest scene point in the image around its
/// own pixel; points behind nearer data are hidden and left out. Robust weights (Tukey) over the
/// annealed reach. Points of a rim look for the end of the data instead. `scene_mm` is the depth
/// image without background, `center_mm` and `radius_mm` the object's sphere.
IcpResult icp(const std::vector<SurfacePoint>& points,
              const Camera& camera,
              const Image<float>& scene_mm,
              const Pose& start,
              const glm::dvec3& center_mm,
              double radius_mm,
              const IcpOptions& options);

}  // namespace host
}  // namespace rangepose
