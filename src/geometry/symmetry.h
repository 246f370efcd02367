// Rotational symmetries of a part: poses that no image can tell apart. The paper (Sect. 9) names
// finding them as future work.
#pragma once

#include <string>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

/// Rotation by any angle about a line.
struct SymmetryAxis {
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit vector, object frame
  glm::dvec3 point_mm{0.0};             ///< a point of the line, object frame
};

/// All rotations that leave the part the same: a discrete one (or none), then one about each
/// continuous axis.
///
/// A part without continuous axis has a finite group (C_n, D_n, T, O, I), closed under composition.
/// A solid of revolution has one continuous axis, and one discrete half turn about a perpendicular
/// axis if its ends are alike. A sphere has three perpendicular continuous axes through its centre.
struct Symmetries {
  std::vector<Pose> discrete;  ///< object_from_object, without the identity
  std::vector<SymmetryAxis> continuous;
  bool none() const { return discrete.empty() && continuous.empty(); }
};

struct SymmetryOptions {
  double tolerance = 0.01;  ///< largest distance of a turned surface to itself, of the diameter
  void check() const;       ///< throws Error naming the bad field
};

/// The rotations that turn the surface onto itself within the tolerance. The mesh needs neither
/// be closed nor evenly tessellated.
///
/// The tolerance decides what a coarse tessellation stands for: a prism of 12 sides has 12
/// rotations when its corners stand out from its sides by more than the tolerance, and is a
/// solid of revolution otherwise. A feature whose size is below the tolerance breaks nothing.
Symmetries findSymmetries(const Mesh& mesh, const SymmetryOptions& options = {});

/// "none", "C2", "D6", "T", "O", "I"; "revolution", "revolution, ends alike", "sphere".
std::string symmetryName(const Symmetries& symmetries);

/// The point that all turns about the axes leave in place: of one axis that nearest to `near_mm`,
/// of several, as a sphere has, where they meet. Without an axis `near_mm`.
glm::dvec3 fixedPoint(const std::vector<SymmetryAxis>& axes, const glm::dvec3& near_mm);

/// All poses of the object that look alike, the identity first. Continuous ones are sampled such
/// that no point within `radius_mm` of the axis moves by more than `step_mm` from one to the next;
/// a sphere's are spread evenly over all rotations, at most 4,096.
std::vector<Pose> symmetricPoses(const Symmetries& symmetries, double radius_mm, double step_mm);

/// Angle between two orientations (camera_from_object) [rad], the smallest over all symmetric
/// copies; continuous axes exactly.
double rotationAngleModulo(const Symmetries& symmetries, const glm::dmat3& a, const glm::dmat3& b);

}  // namespace rangepose
