// Which of the poses that were found to pick first, and which a robot cannot reach (the paper's
// future work).
#pragma once

#include <optional>
#include <vector>

#include "pipeline/estimate.h"

namespace rangepose {

/// A box that a robot reaches.
struct Workspace {
  glm::dvec3 low_mm{0.0};
  glm::dvec3 high_mm{0.0};
};

/// Positions are in the frame of the bin, without a bin in that of the camera. Up is the bin's z,
/// without a bin towards the camera along its axis.
struct PickOptions {
  /// The tool comes down along directions that lean at most this far from straight down [rad],
  /// below 1.4 (80 degrees). 0: straight down only.
  double cone_rad = 0.0;
  double min_freedom = 0.0;            ///< parts that are less free cannot be picked, 0..1
  std::optional<Workspace> workspace;  ///< parts whose centre lies outside cannot be picked
  std::optional<glm::dvec3> arm_mm;    ///< parts near to it go first, in place of high ones
  int max_picks = 0;                   ///< of those that can be picked, the surest; 0: all
  void check() const;                  ///< throws Error naming the bad field
};

struct Pick {
  std::size_t pose = 0;  ///< index into the poses
  /// Share of the surface that the part shows to a tool that comes along `approach`, 0..1, above
  /// which nothing lies: no other part that was found, and no measured point. What the camera did
  /// not see and no pose accounts for counts as empty.
  double freedom = 0.0;
  double height_mm = 0.0;       ///< of the centre of the part, along up [mm]
  glm::dvec3 approach{0.0};     ///< unit vector along which the tool moves, camera frame
  glm::dvec3 position_mm{0.0};  ///< centre of the part (of its bounding sphere), as the workspace
};

/// The poses that can be picked, first the one to pick first: by score times freedom in steps of a
/// tenth; parts in one step by height, the highest first, or where an arm is given by their
/// distance from it; equal ones in the order of `poses`. `poses` are best score first, all of one
/// `depth` image; also those that cannot be picked may lie on others.
///
/// Several directions are tried in a cone: up itself, six at half of its angle and twelve at its
/// border. A part is as free as along the best of them, the first of equal ones.
std::vector<Pick> pickingOrder(const std::vector<PoseEstimate>& poses,
                               const DepthImage& depth,
                               double noise_mm,
                               const std::optional<BinBox>& bin,
                               const ReferenceDatabase& database,
                               const PickOptions& options);

}  // namespace rangepose
