#include "sim/physics_part.h"

#include <LinearMath/btMatrix3x3.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "geometry/solid.h"
#include "sim/convex_hull.h"

namespace rangepose {
namespace {

/// Sums of the signed tetrahedra from a fixed point to each face.
struct Moments {
  double volume = 0.0;
  glm::dvec3 first{0.0};   ///< integral of x
  glm::dmat3 second{0.0};  ///< integral of x x^T

  void add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double six = glm::dot(a, glm::cross(b, c));
    const glm::dvec3 sum = a + b + c;
    volume += six / 6.0;
    first += six / 24.0 * sum;
    second += six / 120.0 *
              (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
               glm::outerProduct(sum, sum));
  }
};

SolidMass massFrom(const Moments& moments, const glm::dvec3& origin, const std::string& name) {
  if (!(moments.volume > 0.0)) {
    throw Error("mesh " + name +
                ": encloses no volume or its faces point inwards; repair the file");
  }
  SolidMass mass;
  mass.volume_mm3 = moments.volume;
  const glm::dvec3 center = moments.first / moments.volume;
  mass.center_mm = origin + center;
  const glm::dmat3 spread = moments.second / moments.volume - glm::outerProduct(center, center);
  const double trace = spread[0][0] + spread[1][1] + spread[2][2];
  // Of order 1, because Bullet's matrices are of single precision.
  const auto entry = [&](int i, int j) {
    return static_cast<btScalar>(((i == j ? trace : 0.0) - spread[i][j]) / trace);
  };
  btMatrix3x3 inertia(entry(0, 0),
                      entry(0, 1),
                      entry(0, 2),
                      entry(1, 0),
                      entry(1, 1),
                      entry(1, 2),
                      entry(2, 0),
                      entry(2, 1),
                      entry(2, 2));
  btMatrix3x3 principal;
  inertia.diagonalize(principal, 1e-6f, 30);
  glm::dmat3 rotation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation[j][i] = static_cast<double>(principal[i][j]);
    mass.inertia[i] = static_cast<double>(inertia[i][i]) * trace;
  }
  mass.object_from_body = {orthonormalized(rotation), mass.center_mm};
  return mass;
}

Moments momentsOf(const Mesh& mesh, const glm::dvec3& origin) {
  Moments moments;
  for (const glm::uvec3& t : mesh.triangles) {
    moments.add(glm::dvec3(mesh.vertices[t.x]) - origin,
                glm::dvec3(mesh.vertices[t.y]) - origin,
                glm::dvec3(mesh.vertices[t.z]) - origin);
  }
  return moments;
}

/// For surfaces with holes.
SolidMass hullMass(const Mesh& mesh, const ConvexHull& hull) {
  const glm::dvec3 origin = boundingBoxCenter(mesh);
  Moments moments;
  for (const std::array<glm::dvec3, 3>& face : hull.triangles) {
    moments.add(face[0] - origin, face[1] - origin, face[2] - origin);
  }
  return massFrom(moments, origin, mesh.name);
}

}  // namespace

SolidMass solidMass(const Mesh& mesh) {
  checkMesh(mesh);
  const glm::dvec3 origin = boundingBoxCenter(mesh);
  return massFrom(momentsOf(mesh, origin), origin, mesh.name);
}

PhysicsPart physicsPart(const Mesh& mesh, const PieceOptions& options) {
  checkMesh(mesh);
  PhysicsPart part;
  part.name = mesh.name;
  part.diameter_mm = diameter(mesh);
  part.closed = isClosed(mesh);
  const ConvexHull hull =
      convexHull(std::vector<glm::dvec3>(mesh.vertices.begin(), mesh.vertices.end()));
  part.hull_mm = hull.corners;
  part.mass = part.closed ? solidMass(mesh) : hullMass(mesh, hull);
  for (const glm::dvec3& corner : part.hull_mm) {
    part.reach_mm = std::max(part.reach_mm, glm::distance(corner, part.mass.center_mm));
  }
  part.pieces = convexPieces(mesh, options);
  return part;
}

}  // namespace rangepose
