// Visible surface discrepancy: the part of the surface, as the depth image shows it, that the
// estimated pose gets wrong (Hodan et al., "BOP: Benchmark for 6D Object Pose Estimation", ECCV
// 2018; visibility as in the BOP challenges since 2019).
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

struct VsdOptions {
  double delta_mm = 15.0;  ///< a model this far behind the data still counts as seen [mm]
  /// Distances from which on a pixel is wrong, as shares of the diameter.
  std::vector<double> taus = {0.05, 0.10, 0.15, 0.20, 0.25, 0.30, 0.35, 0.40, 0.45, 0.50};
  void check() const;  ///< throws Error naming the bad field
};

/// Distances from the eye (along the ray, not along z) of a posed model alone.
struct PosedModel {
  PixelBox box;              ///< where the image shows it [px of the camera]
  Image<float> distance_mm;  ///< of the box; 0 where the model is not seen
};

/// Depth turned into distance from the eye [mm], 0 where nothing was measured. Depth is distance
/// for an orthographic camera.
Image<float> distancesOf(const DepthImage& image);

PosedModel renderPosed(const Mesh& mesh, const Camera& camera, const Pose& camera_from_object);

/// One error for each tau, 0..1; 1 when neither pose is visible. `measured_mm` is distancesOf() the
/// image that both were rendered for.
std::vector<double> vsdErrors(const Image<float>& measured_mm,
                              const PosedModel& estimate,
                              const PosedModel& truth,
                              double diameter_mm,
                              const VsdOptions& options = {});

/// How differently two poses look to the sensor: the share of the pixels at which one of them is
/// seen where the other is not, or `apart_mm` nearer or farther, 0..1; 1 when neither is seen. Seen
/// is what was measured and lies at most `apart_mm` behind it: unlike for VSD, a hole shows
/// nothing, nor does what other parts cover.
double unlikeness(const Image<float>& measured_mm,
                  const PosedModel& estimate,
                  const PosedModel& truth,
                  double apart_mm);

}  // namespace rangepose
