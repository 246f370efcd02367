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
  double hidden = 0.3;           ///< weight of surface well behind nearer data
  double buried = 1.5;           ///< weight of surface just behind nearer data
  double buried_tolerances = 4;  ///< "just behind": by at most this many tolerances
  double weak = 1.0;             ///< weight of the part of an agreeing pixel that does not agree
  double border = 0.9;           ///< share of the score that depends on the outline
};

/// Shares of the model's visible surface (of its rendered pixels); the first six add up to 1.
struct CheckResult {
  double explained = 0.0;      ///< agrees with the data in depth and slope
  double contradicted = 0.0;   ///< in front of the data: the sensor saw through it
  double hidden = 0.0;         ///< well behind nearer data: something lies on it
  double buried = 0.0;         ///< just behind nearer data: the data's surface is not the model's
  double missing = 0.0;        ///< no measurement there
  double weak = 0.0;           ///< near the data, but less than explained
  double outline = 0.0;        ///< share of the outline where the data ends with the model, 0..1
  double residual_mm = 0.0;    ///< mean absolute depth difference of the explained surface [mm]
  double explained_mm2 = 0.0;  ///< explained surface as the camera sees it [mm^2]
  int pixels = 0;              ///< rendered pixels
  double score = 0.0;          ///< 0..1, higher is better
};

namespace host {

/// `surface` was rendered with `window`; `depth` is the whole image as measured.
CheckResult check(const Image<SurfaceTexel>& surface,
                  const SurfaceWindow& window,
                  const DepthImage& depth,
                  const CheckOptions& options);

/// The same for points of the surface, without the outline (outline = 0, its share is left out of
/// the score): cheap, for many hypotheses. `visible_mm2` is the area that the points stand for.
CheckResult checkPoints(const std::vector<SurfacePoint>& points,
                        const Pose& camera_from_object,
                        double visible_mm2,
                        const DepthImage& depth,
                        const CheckOptions& options);

}  // namespace host
}  // namespace rangepose
