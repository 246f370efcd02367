// What a pose says about a depth image: the last step of a peer, with the means of rangepose, so
// that peers differ from it in how poses are found, not in how they are judged.
#pragma once

#include <vector>

#include "core/camera.h"
#include "peers/scene_cloud.h"
#include "pipeline/refine.h"

namespace rangepose::peers {

class Verdict {
 public:
  /// Depth image, database and enclosure must outlive it; `noise_mm` is that of the image.
  Verdict(const DepthImage& depth,
          const ReferenceDatabase& database,
          const Enclosure& enclosure,
          double noise_mm)
      : depth_(depth), database_(database), enclosure_(enclosure), noise_mm_(noise_mm) {}

  /// Sets check, rank and confidence as rangepose does for a pose that it has aligned.
  void judge(Candidate& candidate) const;

  /// Sets the rank of a pose before ICP: tolerance as wide as such a pose is wrong, few pixels.
  void glance(Candidate& candidate) const;

  /// What the camera would see of the posed object, in the object's frame, without what lies behind
  /// nearer data by more than `reach_mm`; about `count` points.
  Cloud visible(const Candidate& candidate, double reach_mm, int count) const;

 private:
  const ReferenceObject& objectOf(const Candidate& candidate) const;
  CheckResult checked(const Candidate& candidate, const CheckOptions& options, int pixels) const;

  const DepthImage& depth_;
  const ReferenceDatabase& database_;
  const Enclosure& enclosure_;
  double noise_mm_;
};

}  // namespace rangepose::peers
