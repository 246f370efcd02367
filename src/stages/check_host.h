// The verdict on a pose: the posed model against the full depth image, background included.
#pragma once

#include "core/camera.h"
#include "geometry/mesh.h"
#include "stages/check_core.h"
#include "stages/surface.h"
#include "stages/surface_points.h"

namespace rangepose {

namespace host {

/// `surface` was rendered with `window`; `depth` is the whole image as measured, `sphere` that
/// around the object, in the camera frame.
CheckResult check(const Image<SurfaceTexel>& surface,
                  const SurfaceWindow& window,
                  const DepthImage& depth,
                  const Sphere& sphere,
                  const CheckOptions& options);

/// The same for points of the surface, without the outline (outline = 0, its share is left out of
/// the score): cheap, for many hypotheses. Points of rims have no say. `visible_mm2` is the area
/// that the others stand for.
CheckResult checkPoints(const std::vector<SurfacePoint>& points,
                        const Pose& camera_from_object,
                        double visible_mm2,
                        const DepthImage& depth,
                        const CheckOptions& options);

}  // namespace host
}  // namespace rangepose
