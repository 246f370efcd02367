// How far apart two poses of an object are, for telling duplicates from different answers.
#pragma once

#include <vector>

#include "core/pose.h"
#include "stages/reference.h"

namespace rangepose {

/// Mean distance of a few points of the object in two poses, as a share of its diameter: the
/// smallest over all symmetric copies of one of them. For a solid of revolution only the course of
/// its axis counts, for a sphere only its centre. The symmetries may be any, and about any point.
class PoseDistance {
 public:
  explicit PoseDistance(const ReferenceObject& object);
  double operator()(const Pose& a, const Pose& b) const;
  /// Whether the distance is below `limit`; cheaper where the poses are far apart.
  bool below(double limit, const Pose& a, const Pose& b) const;

 private:
  friend class PoseList;
  /// Where poses are that close, their middles are no farther apart [mm].
  double middlesWithinMm(double limit) const;

  glm::dvec3 middle_mm_;  ///< the mean of the points, which the symmetries leave in place
  double diameter_mm_;
  std::vector<glm::dvec3> points_mm_;
  std::vector<std::vector<glm::dvec3>> copies_mm_;  ///< the points in each symmetric copy
  double most_moved_mm_ = 0.0;  ///< the middle by a symmetry: by what that is inexact
};

/// Poses of one object, none of which is to be like another.
class PoseList {
 public:
  explicit PoseList(const ReferenceObject& object) : distance_(object) {}
  /// Whether the distance of one of them is below `limit`.
  bool holds(double limit, const Pose& pose) const;
  void add(const Pose& pose);

 private:
  PoseDistance distance_;
  std::vector<Pose> poses_;
  std::vector<glm::dvec3> middles_mm_;
};

}  // namespace rangepose
