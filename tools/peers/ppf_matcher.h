// OpenCV contrib's surface_matching for one object: point pair features, and its ICP. The only file
// of the peers that knows OpenCV.
//
// What must be known of OpenCV 4.6:
// - RelativeDistanceStep is ignored, RelativeSamplingStep sets the step of distances, too; the
//   cells of the sampling follow the bounding box side by side. So points are thinned here before.
// - Its clustering compares angles of rotations, not rotations, and with a default limit that all
//   pass; poses of one cluster are averaged. It is turned off by limits that no pose passes.
// - Angles are counted over two turns, so that a pose's turn about a normal is rounded to 18
//   degrees for 40 angles (24 for 30): a pose is a start for ICP, not an answer.
// - Learning takes time with the square of the number of equal pairs, minutes for a few thousand
//   points of a turned part: hence a limit to their number.
#pragma once

#include <memory>
#include <opencv2/surface_matching.hpp>
#include <vector>

#include "core/pose.h"
#include "peers/scene_cloud.h"
#include "stages/reference.h"

namespace rangepose::peers {

struct PpfOptions {
  double spacing = 0.05;         ///< of the points of model and scene [share of the diameter]
  int most_points = 700;         ///< of the model; with more of them the spacing grows
  double distance_step = 0.05;   ///< of distances of pairs [share of the box's diagonal]
  int angles = 30;               ///< steps of a full turn
  double reference_share = 0.2;  ///< of a crop's points that vote
};

struct PpfIcpOptions {
  int iterations = 60;
  float tolerance = 0.002f;  ///< relative change of the error at which a level ends
  float rejection = 2.5f;    ///< pairs farther apart than so many standard deviations are left out
  int levels = 3;            ///< of the pyramid
};

struct PpfHypothesis {
  Pose camera_from_object;
  double votes = 0.0;
};

/// Not for two threads at a time: OpenCV's match() writes to its object.
class PpfMatcher {
 public:
  /// Learns the surface that the views of the object show.
  PpfMatcher(const ReferenceObject& object, const PpfOptions& options);

  /// Between the points of the model, and those that the scene should have [mm].
  double spacingMm() const { return spacing_mm_; }

  /// One hypothesis for each point of the crop that votes, most votes first. The crop is in the
  /// camera frame; fewer than 30 points give none.
  std::vector<PpfHypothesis> match(const Cloud& crop);

  /// The start moved by OpenCV's ICP so that `surface` (object frame) lies on `scene` (camera
  /// frame); the start where that fails.
  Pose align(const Cloud& surface,
             const Cloud& scene,
             const Pose& start,
             const PpfIcpOptions& options) const;

 private:
  double diameter_mm_;
  double spacing_mm_;
  PpfOptions options_;
  std::unique_ptr<cv::ppf_match_3d::PPF3DDetector> detector_;
};

}  // namespace rangepose::peers
