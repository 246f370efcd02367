// How much of each found part is covered by others, seen along a direction.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/estimate.h"

namespace rangepose {

/// What lies in the scene: the parts that were found, whole, and what was measured beside them.
class FoundScene {
 public:
  /// All must outlive it. `poses` are of parts in `depth`.
  FoundScene(const std::vector<PoseEstimate>& poses,
             const DepthImage& depth,
             double noise_mm,
             const ReferenceDatabase& database);

  /// Of each part the share, 0..1, of the surface seen along the unit vector `direction` (camera
  /// frame) by parallel rays, in front of which nothing lies; 0 for a part that is not seen at all.
  std::vector<double> freedom(const glm::dvec3& direction) const;

 private:
  OrthoCamera viewAlong(const glm::dvec3& direction) const;
  const ReferenceObject& objectOf(const PoseEstimate& pose) const;

  const std::vector<PoseEstimate>& poses_;
  const DepthImage& depth_;
  double noise_mm_;
  const ReferenceDatabase& database_;
  Image<std::uint8_t> unexplained_;  ///< 1 where no part accounts for the measured depth
  double reach_mm_ = 0.0;            ///< all that is in the scene lies this near to the camera
};

}  // namespace rangepose
