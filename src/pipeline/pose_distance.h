// How far apart two poses of an object are, for telling duplicates from different answers.
#pragma once

#include <vector>

#include "core/pose.h"
#include "stages/reference.h"

namespace rangepose {

/// Mean distance of a few points of the object in two poses, as a share of its diameter: the
/// smallest over all symmetric copies of one of them. For a solid of revolution only the course of
/// its axis counts, for a sphere only its centre.
class PoseDistance {
 public:
  explicit PoseDistance(const ReferenceObject& object);
  double operator()(const Pose& a, const Pose& b) const;
  /// Whether the distance is below `limit`; cheaper where the poses are far apart.
  bool below(double limit, const Pose& a, const Pose& b) const;

 private:
  friend class PoseList;
  /// Centres of poses that are that close are no farther apart [mm].
  double centersWithinMm(double limit) const;

  glm::dvec3 center_mm_;
  double diameter_mm_;
  std::vector<glm::dvec3> points_mm_;
  std::vector<std::vector<glm::dvec3>> copies_mm_;  ///< the points in each symmetric copy
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
  std::vector<glm::dvec3> centers_mm_;
};

}  // namespace rangepose
