// How well rotations turn a surface onto itself, and the frame in which they do it best.
#pragma once

#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"
#include "geometry/triangle_tree.h"

namespace rangepose {

/// Where a group of rotations sits: a rotation g of the group's own frame turns the object by
/// axes * g * axes^T about the centre.
struct GroupFrame {
  glm::dmat3 axes{1.0};       ///< object_from_group
  glm::dvec3 centre_mm{0.0};  ///< object frame
};

/// The rotation of the group as a motion of the object.
Pose motionOf(const GroupFrame& frame, const glm::dmat3& element);

/// A frame whose z axis is `direction`.
GroupFrame frameAbout(const glm::dvec3& direction, const glm::dvec3& centre_mm);

class SurfaceMatch {
 public:
  explicit SurfaceMatch(const Mesh& mesh);

  const TriangleTree& tree() const { return tree_; }
  /// Evenly spread points.
  const std::vector<glm::dvec3>& sample() const { return sample_; }

  /// Whether all elements move no point of the surface farther than `reach_mm` away from it. As a
  /// group holds the inverse of each element, that bounds the distance the other way, too.
  /// `thorough`: the points include the vertices, so that no small feature is missed.
  bool maps(const GroupFrame& frame,
            const std::vector<glm::dmat3>& elements,
            double reach_mm,
            bool thorough) const;

  /// The frame, near the one given, with the least sum of squared distances over all elements.
  GroupFrame refined(GroupFrame frame, const std::vector<glm::dmat3>& elements) const;

  /// The rotation about `centre_mm`, near the one given, with the least sum of squared distances.
  glm::dmat3 refinedRotation(const glm::dmat3& rotation, const glm::dvec3& centre_mm) const;

 private:
  TriangleTree tree_;
  std::vector<glm::dvec3> sample_;
  std::vector<glm::dvec3> quick_points_;
  std::vector<glm::dvec3> all_points_;  ///< even ones and vertices, mixed
  double radius_mm_ = 1.0;
};

}  // namespace rangepose
