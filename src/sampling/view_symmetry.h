// Viewing directions of a symmetric part: which of them show the same picture.
#pragma once

#include <vector>

#include "core/glm.h"
#include "geometry/symmetry.h"

namespace rangepose {

/// A rotation R (camera_from_object) views the part along the direction third row of R, in the
/// object's frame. A symmetry S of the part makes R and R * S look the same, and so the
/// directions d and S^T d.
///
/// Continuous axes are dealt with once for all by `folded`; what is left is a finite group.
class ViewSymmetry {
 public:
  explicit ViewSymmetry(const Symmetries& symmetries);

  bool sphere() const { return sphere_; }
  bool revolution() const { return revolution_; }
  /// Of a solid of revolution: whether turning its axis around leaves it the same.
  bool endsAlike() const { return ends_alike_; }
  const glm::dvec3& axis() const { return axis_; }
  /// The finite part of the group, the identity first; only the identity for a solid of revolution.
  const std::vector<glm::dmat3>& elements() const { return elements_; }

  /// A rotation that looks the same as `rotation`. For a solid of revolution the one whose
  /// direction lies in a fixed half-plane through the axis, on the side of its direction if the
  /// ends are alike; otherwise `rotation` itself.
  glm::dmat3 folded(const glm::dmat3& rotation) const;

  /// In how many in-plane angles, evenly spaced, the part looks nearly the same from `direction`:
  /// the group elements that move the direction by at most `reach` [rad].
  int inPlaneCopies(const glm::dvec3& direction, double reach) const;

  /// How far a point moves when the part is turned in the plane, over the angle of the turn: 1, or
  /// for a solid of revolution the sine between axis and direction.
  double inPlaneEffect(const glm::dvec3& direction) const;

 private:
  bool sphere_ = false;
  bool revolution_ = false;
  bool ends_alike_ = false;
  glm::dvec3 axis_{0.0, 0.0, 1.0};
  glm::dvec3 side_{1.0, 0.0, 0.0};  ///< of the half-plane
  glm::dmat3 half_turn_{1.0};
  std::vector<glm::dmat3> elements_;
};

/// The direction in which a camera looks at the object, in the object's frame.
inline glm::dvec3 viewDirection(const glm::dmat3& camera_from_object) {
  return {camera_from_object[0][2], camera_from_object[1][2], camera_from_object[2][2]};
}

/// The smallest rotation that turns unit vector `from` into `to`.
glm::dmat3 shortestTurn(const glm::dvec3& from, const glm::dvec3& to);

}  // namespace rangepose
