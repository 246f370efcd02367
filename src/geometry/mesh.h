// A triangle mesh in millimetres.
#pragma once

#include <string>
#include <vector>

#include "core/glm.h"

namespace rangepose {

struct Mesh {
  std::string name;                   ///< for messages and results, e.g. the file's stem
  std::vector<glm::vec3> vertices;    ///< [mm]
  std::vector<glm::uvec3> triangles;  ///< indices into vertices
  /// The back of no face is seen from outside (isSolid() says so); false: not known.
  bool solid = false;
};

struct Sphere {
  glm::dvec3 center_mm{0.0};
  double radius_mm = 0.0;
};

/// Throws Error, naming the mesh and the element, when there is no triangle with an area, an index
/// is out of range, or a vertex is not finite.
void checkMesh(const Mesh& mesh);

/// Removes triangles without area and vertices that no triangle uses.
Mesh cleaned(const Mesh& mesh);

/// The smallest sphere around all vertices. A rotation that maps them onto themselves leaves its
/// centre in place. The radius is the distance of the farthest vertex from the centre, so that none
/// is outside by rounding.
Sphere boundingSphere(const Mesh& mesh);

/// The largest distance between two vertices [mm] (BOP's "diameter").
double diameter(const Mesh& mesh);

/// Centre of the axis-parallel bounding box [mm]: amid the part, but not where its symmetries are.
glm::dvec3 boundingBoxCenter(const Mesh& mesh);

/// Length of the diagonal of the axis-parallel bounding box [mm] (the paper's error unit).
double boundingBoxDiagonal(const Mesh& mesh);

}  // namespace rangepose
