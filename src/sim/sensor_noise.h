// What a structured-light or laser sensor makes of a surface: holes, noise and steps.
#pragma once

#include <optional>

#include "core/camera.h"
#include "sim/random.h"
#include "stages/surface.h"

namespace rangepose {

struct SensorNoise {
  double sigma_mm =
      0.0;  ///< deviation of depth at 1 m on a surface that faces the camera; grows with z^2
  double edge_loss = 0.0;  ///< chance that a pixel beside a jump in depth is lost
  double edge_mix =
      0.0;               ///< chance that it lies anywhere between the two sides of the jump instead
  double jump_mm = 3.0;  ///< what counts as a jump
  double grazing_cosine =
      0.0;  ///< surfaces more oblique than this to the ray lose pixels, all of them at 0
  double random_loss = 0.0;  ///< chance that any pixel is lost
};

/// 1: a good structured-light sensor. 2: a rough one: a millimetre at 1 m, a tenth of all pixels
/// lost.
SensorNoise sensorNoise(int level);

/// Depth as the projector would see it: what it does not see is not lit.
struct ProjectorView {
  Camera camera;          ///< rectified: same orientation and focal length as the depth camera's
  Image<float> depth_mm;  ///< 0 nothing
  glm::dvec3 position_mm{0.0};  ///< in the depth camera's frame: along its x, or along its y
};

Image<float> depthOf(const Image<SurfaceTexel>& surface);

/// Whether the projector lights a point, given in the projector's own frame [mm].
bool isLit(const ProjectorView& projector, const glm::dvec3& point_mm);

/// Depth as measured, in whole steps of camera.depth_scale; 0 where it is lost. Without a projector
/// all is lit.
Image<float> sensed(const Image<SurfaceTexel>& surface,
                    const Camera& camera,
                    const std::optional<ProjectorView>& projector,
                    const SensorNoise& noise,
                    Random& random);

}  // namespace rangepose
