// Meshes with fewer triangles.
#pragma once

#include "geometry/mesh.h"

namespace rangepose {

/// The mesh with as few triangles as edge collapses leave where neither surface is farther than
/// `max_error_mm` from the other one, at the corners, the middles of the edges and the centres of
/// its triangles. CAD systems write flat faces as slivers and fillets as thousands of facets: what
/// no sensor sees only costs time.
///
/// Vertices are some of those of the mesh, the name stays, a solid stays one. The mesh itself comes
/// back for an error of 0, where more than two faces meet at an edge, and where nothing can be left
/// out.
///
/// Collapses in the order of their quadric errors (Garland and Heckbert 1997, "Surface
/// simplification using quadric error metrics") by OpenMesh.
Mesh simplified(const Mesh& mesh, double max_error_mm);

}  // namespace rangepose
