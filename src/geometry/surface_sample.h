// Points spread evenly over the area of a mesh, and the moments of its area.
#pragma once

#include <vector>

#include "core/glm.h"
#include "geometry/mesh.h"

namespace rangepose {

/// `count` points of the surface, as many on each piece as its share of the area; any first part
/// of them is spread evenly, too. The same mesh always gives the same points.
std::vector<glm::dvec3> surfaceSample(const Mesh& mesh, int count);

/// Diagonalises a symmetric matrix by Jacobi rotations: the columns of the result are its
/// eigenvectors, `matrix` becomes diagonal.
glm::dmat3 diagonalise(glm::dmat3& matrix);

struct AreaMoments {
  glm::dvec3 centroid_mm{0.0};  ///< of the area
  glm::dmat3 axes{1.0};         ///< columns: unit principal directions, right-handed
  glm::dvec3 spread_mm2{0.0};   ///< variance of the area along each of them, falling [mm^2]
};
AreaMoments areaMoments(const Mesh& mesh);

/// The smallest extent along one of those directions [mm]: of a plate its thickness.
double thickness(const Mesh& mesh);

}  // namespace rangepose
