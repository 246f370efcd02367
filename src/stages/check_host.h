// The verdict on a pose: the posed model against the full depth image, background included.
#pragma once

#include "core/camera.h"
#include "stages/surface.h"
#include "stages/surface_points.h"

namespace rangepose {

struct CheckOptions {
  double tolerance_mm = 2.0;     ///< surfaces this close are the same [mm]
  double max_tilt_rad = 0.6;     ///< normals of the same surface differ by at most this [rad]
  double contradicted = 2.0;     ///< weight of surface in front of the data in the score
  double missing = 0.5;          ///< weight of surface where nothing was measured
  double hidden = 0.35;          ///< weight of surface behind nearer data
  double border = 0.5;           ///< share of the score that depends on the outline
};

/// Shares of the model's visible surface (of its rendered pixels); the first four add up to 1.
struct CheckResult {
  double explained = 0.0;     ///< agrees with the data in depth and slope
  double contradicted = 0.0;  ///< in front of the data: the sensor saw through it
  double hidden = 0.0;        ///< behind nearer data
  double missing = 0.0;       ///< no measurement there
  double outline = 0.0;       ///< share of the outline where the data ends with the model, 0..1
  double residual_mm = 0.0;   ///< mean absolute depth difference of the explained surface [mm]
  int pixels = 0;             ///< rendered pixels
  double score = 0.0;         ///< 0..1, higher is better
};

namespace host {

/// `surface` was rendered with `window`; `depth` is the whole image as measured.
CheckResult check(const Image<SurfaceTexel>& surface,
                  const SurfaceWindow& window,
                  const DepthImage& depth,
                  const CheckOptions& options);

/// The same for points of the surface, without the outline (outline = 0, its share is left out of the
/// score): cheap, for many hypotheses.
CheckResult checkPoints(const std::vector<SurfacePoint>& points,
                        const Pose& camera_from_object,
                        const DepthImage& depth,
                        const CheckOptions& options);

}  // namespace host
}  // namespace rangepose
