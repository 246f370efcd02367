// Whether a mesh bounds a solid.
#pragma once

#include "geometry/mesh.h"

namespace rangepose {

/// Each edge is used as often in one direction as in the other. Vertices at the same place count as
/// one, so that the seams of an STL or a textured mesh do not open it.
bool isClosed(const Mesh& mesh);

/// Closed, and each of its connected surfaces faces outwards: from outside no back is ever seen. A
/// mesh with an inner cavity counts as none.
bool isSolid(const Mesh& mesh);

}  // namespace rangepose
