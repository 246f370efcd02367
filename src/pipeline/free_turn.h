// Where a pose is not held: a part turned about the bore that is seen of it, with its arm behind,
// looks nearly the same. What tells these poses apart is too little for an alignment to follow.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "pipeline/refine.h"
#include "stages/surface.h"

namespace rangepose {

/// Poses that are nearer than this to the true one are right in all figures [diameters].
inline constexpr double kTurnedApart = 0.1;

/// A line, and what happens to the seen surface of a part that turns about it.
struct FreeTurn {
  glm::dvec3 axis{0.0};        ///< unit vector, camera frame
  glm::dvec3 on_axis_mm{0.0};  ///< a point of the line, camera frame
  double change_mm = 0.0;  ///< of the seen surface along its normals, root mean square, by a turn
                           ///< that moves no point of the part by more than kTurnedApart
};

/// The line about which what is seen of a posed part turns with the least change: that of the
/// smallest sum of squares of n . (w x p + v) over its points p and normals n, for unit w and any v
/// (the slippage of Gelfand and Guibas 2004, for turns). Seen are pixels of the rendered `surface`
/// that lie within `tolerance_mm` of the data; none where they are fewer than 30. The window is one
/// of the image, with step 1.
std::optional<FreeTurn> freestTurn(const Image<SurfaceTexel>& surface,
                                   const SurfaceWindow& window,
                                   const DepthImage& depth,
                                   const ReferenceObject& object,
                                   const Pose& camera_from_object,
                                   double tolerance_mm);

/// The candidate turned about that line, by all multiples of a full turn / `steps` but 0.
std::vector<Candidate> turnedAbout(const FreeTurn& line, const Candidate& candidate, int steps);

}  // namespace rangepose
