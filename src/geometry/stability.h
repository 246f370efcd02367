// How firmly a surface holds its pose: the covariance of the rows of point-to-plane alignment
// (Gelfand, Ikemoto, Rusinkiewicz, Levoy 2003, "Geometrically stable sampling for the ICP
// algorithm").
#pragma once

#include "core/device.h"
#include "core/glm.h"
#include "geometry/mesh.h"

namespace rangepose {

/// Mean over a surface of row^T row, row = (r x n, n): r is a point relative to the centre of the
/// object's sphere, in its radii, n the unit normal there. Nothing but doubles.
struct StabilityCovariance {
  double upper[21] = {};  ///< triangle, row by row

  RP_HD void add(const glm::dvec3& point_radii, const glm::dvec3& normal, double weight) {
    const glm::dvec3 turn = glm::cross(point_radii, normal);
    const double row[6] = {turn.x, turn.y, turn.z, normal.x, normal.y, normal.z};
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) upper[k++] += weight * row[i] * row[j];
    }
  }
  RP_HD void scale(double factor) {
    for (double& sum : upper) sum *= factor;
  }
};

/// Of all faces of a mesh, in its own frame.
StabilityCovariance stabilityCovariance(const Mesh& mesh, const Sphere& sphere);

/// How much of what holds the whole surface holds a part of it, in the direction in which that is
/// least, 0..1: the smallest generalized eigenvalue of the two. A plate seen from above slides on
/// its faces and gives 0; a turn that leaves the object as it is, which nothing holds, does not
/// count. `part` is in a frame that `part_from_whole` turns the whole into.
double stability(const StabilityCovariance& part,
                 const StabilityCovariance& whole,
                 const glm::dmat3& part_from_whole);

}  // namespace rangepose
