// What a pose says about a depth image: the last step of a peer, with the means of rangepose, so
// that peers differ from it in how poses are found, not in how they are judged.
#pragma once

#include <vector>

#include "core/camera.h"
#include "peers/scene_cloud.h"
#include "stages/check_core.h"
#include "stages/reference.h"

namespace rangepose::peers {

struct Scored {
  int object = 0;  ///< index into the database
  Pose camera_from_object;
  double score = 0.0;  ///< of the check, 0..1
};

class Verdict {
 public:
  /// `depth` must outlive it; `noise_mm` is that of the image.
  Verdict(const DepthImage& depth, double noise_mm) : depth_(depth), noise_mm_(noise_mm) {}

  /// The check that rangepose makes.
  double score(const ReferenceObject& object, const Pose& pose) const;

  /// The same with a tolerance as wide as a pose before ICP is wrong, at low resolution.
  double glance(const ReferenceObject& object, const Pose& pose) const;

  /// What the camera would see of the posed object, in the object's frame, without what lies behind
  /// nearer data by more than `reach_mm`; about `count` points.
  Cloud visible(const ReferenceObject& object, const Pose& pose, double reach_mm, int count) const;

  /// The best poses that do not explain the same pixels, best first: each must explain three
  /// quarters of its own alone, and none may be a symmetric copy of a better one.
  std::vector<Scored> withoutRivals(std::vector<Scored> poses,
                                    const std::vector<ReferenceObject>& objects,
                                    double min_score) const;

 private:
  std::vector<glm::ivec2> explained(const ReferenceObject& object, const Pose& pose) const;

  const DepthImage& depth_;
  double noise_mm_;
};

}  // namespace rangepose::peers
