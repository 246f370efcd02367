#include "io/mesh_simplify.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "geometry/solid.h"
#include "geometry/triangle_corners.h"
#include "geometry/triangle_tree.h"

namespace rangepose {
namespace {

struct Doubles : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Halfedges = OpenMesh::TriMesh_ArrayKernelT<Doubles>;
namespace om = OpenMesh::Decimater;

/// Nothing where faces meet in a way that halfedges cannot tell: three on an edge, say.
std::optional<Halfedges> halfedgesOf(const Mesh& mesh) {
  omerr().disable();  // it would say so itself
  Halfedges result;
  std::vector<Halfedges::VertexHandle> at;
  for (const glm::vec3& vertex : mesh.vertices)
    at.push_back(result.add_vertex(OpenMesh::Vec3d(vertex.x, vertex.y, vertex.z)));
  for (const glm::uvec3& corners : mesh.triangles) {
    if (!result.add_face(at[corners.x], at[corners.y], at[corners.z]).is_valid())
      return std::nullopt;
  }
  return result;
}

Mesh meshOf(const Halfedges& halfedges, const std::string& name) {
  Mesh result;
  result.name = name;
  for (const auto vertex : halfedges.vertices()) {
    const OpenMesh::Vec3d& at = halfedges.point(vertex);
    result.vertices.emplace_back(at[0], at[1], at[2]);
  }
  for (const auto face : halfedges.faces()) {
    glm::uvec3& triangle = result.triangles.emplace_back();
    int corner = 0;
    for (const auto vertex : halfedges.fv_range(face))
      triangle[corner++] = static_cast<unsigned>(vertex.idx());
  }
  return cleaned(result);
}

/// `error_mm` bounds the root of the quadric of each collapse.
Mesh collapsed(Halfedges halfedges, const std::string& name, double error_mm) {
  constexpr float kMostTurned = 30.0f;  // of a face [deg]
  // Quadrics of faces alone would let the outline of a sheet shrink.
  halfedges.request_vertex_status();
  for (const auto vertex : halfedges.vertices())
    halfedges.status(vertex).set_locked(halfedges.is_boundary(vertex));
  halfedges.request_face_normals();
  halfedges.update_face_normals();
  om::DecimaterT<Halfedges> decimater(halfedges);
  om::ModQuadricT<Halfedges>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).set_max_err(error_mm * error_mm);
  // Also keeps faces from folding over and from losing their area.
  om::ModNormalFlippingT<Halfedges>::Handle flipping;
  decimater.add(flipping);
  decimater.module(flipping).set_max_normal_deviation(kMostTurned);
  decimater.initialize();
  decimater.decimate(0);
  halfedges.garbage_collection();
  return meshOf(halfedges, name);
}

/// Whether corners, middles of edges and centres of all triangles lie near the other surface.
bool liesNear(const Mesh& mesh, const TriangleTree& other, double reach_mm) {
  constexpr int kTrianglesPerPiece = 256;
  std::atomic<bool> near = true;
  parallelForEach(mesh.triangles.size(), kTrianglesPerPiece, [&](std::size_t i) {
    if (!near) return;
    const TriangleCorners at(mesh, mesh.triangles[i]);
    const glm::dvec3 points[] = {at.a,
                                 at.b,
                                 at.c,
                                 0.5 * (at.a + at.b),
                                 0.5 * (at.b + at.c),
                                 0.5 * (at.c + at.a),
                                 (at.a + at.b + at.c) / 3.0};
    const bool all = std::all_of(std::begin(points), std::end(points), [&](const auto& point) {
      return other.touches(point, reach_mm);
    });
    if (!all) near = false;
  });
  return near;
}

}  // namespace

Mesh simplified(const Mesh& mesh, double max_error_mm) {
  // What quadrics promise and what is measured differ by a factor of one to three.
  constexpr double kFirst = 0.5;
  constexpr int kTries = 4;
  if (!(max_error_mm > 0.0)) return mesh;
  const std::optional<Halfedges> halfedges = halfedgesOf(mesh);
  if (!halfedges) return mesh;
  const bool solid = isSolid(mesh);
  const TriangleTree own(mesh);
  double error_mm = kFirst * max_error_mm;
  for (int i = 0; i < kTries; ++i, error_mm *= 0.5) {
    Mesh result = collapsed(*halfedges, mesh.name, error_mm);
    if (result.triangles.empty() || (solid && !isSolid(result))) continue;
    if (liesNear(result, own, max_error_mm) && liesNear(mesh, TriangleTree(result), max_error_mm))
      return result;
  }
  return mesh;
}

}  // namespace rangepose
