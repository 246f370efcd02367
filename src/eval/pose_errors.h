// How wrong an estimated pose is, modulo the symmetry of the part: the errors of the BOP challenge
// (Hodan et al., "BOP Challenge 2020 on 6D Object Localization", ECCVW 2020), ADD and ADI
// (Hinterstoisser et al., ACCV 2012), and the paper's vertex and angle errors (Sect. 8.2).
//
// All of them are exactly 0 where the estimate is the truth, and 0 but for rounding where it is a
// symmetric copy of it.
#pragma once

#include <limits>
#include <vector>

#include "core/camera.h"
#include "core/pose.h"
#include "eval/point_tree.h"
#include "geometry/mesh.h"
#include "geometry/symmetry.h"

namespace rangepose {

/// A part as the errors see it.
class ErrorModel {
 public:
  /// Throws Error for a mesh that checkMesh refuses.
  ErrorModel(const Mesh& mesh, const Symmetries& symmetries);

  const Mesh& mesh() const { return mesh_; }
  const Symmetries& symmetries() const { return symmetries_; }
  double diameterMm() const { return diameter_mm_; }  ///< largest distance of two vertices
  double diagonalMm() const { return diagonal_mm_; }  ///< of the bounding box: the paper's unit
  const Sphere& sphere() const { return sphere_; }
  /// The vertices, farthest from their mean first: those decide early that a pose is wrong.
  const std::vector<glm::dvec3>& points() const { return points_; }
  const glm::dvec3& mean() const { return mean_; }  ///< of the vertices [mm]
  const PointTree& tree() const { return tree_; }   ///< of points()
  /// object_from_object of all poses that look alike, the identity first; turns about an axis of
  /// revolution in steps that move no vertex by more than 1 % of the diameter, as in BOP. Only the
  /// identity for a sphere, whose turns are not sampled.
  const std::vector<Pose>& copies() const { return copies_; }
  double stepRad() const { return step_rad_; }  ///< of two copies about the axis, or a little more

 private:
  Mesh mesh_;
  Symmetries symmetries_;
  double diameter_mm_ = 0.0;
  double diagonal_mm_ = 0.0;
  Sphere sphere_;
  glm::dvec3 mean_{0.0};
  std::vector<glm::dvec3> points_;
  PointTree tree_;
  std::vector<Pose> copies_;
  double step_rad_ = 0.0;
};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Mean distance of corresponding vertices [mm]; blind to symmetry.
double addErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth);

/// Mean distance of each vertex of the true pose to the nearest one of the estimated pose [mm]
/// (also called ADD-S).
double adiErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth);

/// Largest distance of corresponding vertices, the smallest over the symmetric copies [mm].
/// Differs from BOP in that turns between the sampled copies are tried, too: never more than BOP's
/// value. Errors above `limit_mm` are cheaper: then any value above it is returned. The limit must
/// not be below 1 % of the diameter.
double mssdErrorMm(const ErrorModel& model,
                   const Pose& estimate,
                   const Pose& truth,
                   double limit_mm = kNoLimit);

/// The same for the distance of the projected vertices [px]. Infinite when a vertex lies behind the
/// camera.
double mspdErrorPx(const ErrorModel& model,
                   const Camera& camera,
                   const Pose& estimate,
                   const Pose& truth,
                   double limit_px = kNoLimit);

/// Mean distance of corresponding vertices, the smallest over the symmetric copies [mm]: the
/// paper's vertex error before it is divided by the diagonal of the bounding box.
double vertexErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth);

/// The symmetric copy of the true pose that vertexErrorMm compares with.
Pose nearestCopy(const ErrorModel& model, const Pose& estimate, const Pose& truth);

/// The smallest angle that turns the estimate into a symmetric copy of the truth [rad], 0..pi.
double rotationErrorRad(const ErrorModel& model, const Pose& estimate, const Pose& truth);

/// Distance of the object's origin to that of nearestCopy() [mm].
double translationErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth);

/// Turns about the x, then y, then z axis of the camera that lead from nearestCopy() to the
/// estimate [rad], as magnitudes.
///
/// Differs from the paper: it subtracts the Euler angles of the two poses, which near gimbal lock
/// differ much for poses that hardly do.
glm::dvec3 eulerErrorRad(const ErrorModel& model, const Pose& estimate, const Pose& truth);

}  // namespace rangepose
