// What the physics of a drop knows about a part: convex pieces that cover its surface, its mass and
// its inertia.
#pragma once

#include <string>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

struct PieceOptions {
  int max_pieces = 6;     ///< convex pieces of a part at most
  int max_vertices = 48;  ///< of a piece at most
  double detail = 0.003;  ///< what simplifying a piece may cut off, of the diameter
  double gain = 0.02;  ///< a cut must free this part of the hull's volume, or else it is not made
  void check() const;  ///< throws Error naming the bad field
};

/// A convex piece as its corners.
struct ConvexPiece {
  std::vector<glm::dvec3> corners_mm;  ///< object frame
  double short_mm = 0.0;  ///< the surface of the mesh reaches at most this far out of the piece
};

/// Mass and inertia of a solid of density 1, from its closed surface.
struct SolidMass {
  double volume_mm3 = 0.0;
  glm::dvec3 center_mm{0.0};  ///< of mass, object frame
  Pose object_from_body;      ///< the principal frame: origin at the centre of mass
  glm::dvec3 inertia{0.0};    ///< about the principal axes over the mass [mm^2]
};

struct PhysicsPart {
  std::string name;
  double diameter_mm = 0.0;
  double reach_mm = 0.0;  ///< from the centre of mass to the farthest vertex
  SolidMass mass;
  /// False where the surface has holes: mass and inertia are those of its convex hull then.
  bool closed = true;
  std::vector<ConvexPiece> pieces;
  std::vector<glm::dvec3> hull_mm;  ///< corners of the convex hull of all, object frame
};

/// Exact for a closed mesh (integrals over the faces). Throws Error where there is no volume.
SolidMass solidMass(const Mesh& mesh);

/// Pieces whose union holds the surface of the mesh: cut again and again where it frees most of the
/// hull's volume. Hollows that no cut can free are filled.
std::vector<ConvexPiece> convexPieces(const Mesh& mesh, const PieceOptions& options = {});

/// Takes a second or so for a part of some thousand faces; to be kept for all bins.
PhysicsPart physicsPart(const Mesh& mesh, const PieceOptions& options = {});

}  // namespace rangepose
