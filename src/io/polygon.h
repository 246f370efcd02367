// Cutting polygons into triangles.
#pragma once

#include <vector>

#include "core/glm.h"

namespace rangepose {

/// Appends the triangles of a simple, nearly flat polygon (ear clipping), wound as the polygon is.
/// `corners` are indices into `vertices` and in range. Corners that leave no ear (a polygon that crosses
/// itself) are cut off one by one, so that n corners always give n - 2 triangles.
void appendTriangles(const std::vector<glm::dvec3>& vertices,
                     std::vector<unsigned> corners,
                     std::vector<glm::uvec3>& triangles);

}  // namespace rangepose
