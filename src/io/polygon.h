// Meshes as files hold them, and cutting their polygons into triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/glm.h"

namespace rangepose {

/// A mesh in the unit of its file.
struct RawMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;  ///< indices into vertices, in range; may be empty
};

/// Most corners of a polygon in a file: cutting takes at least their square in time.
inline constexpr int kMaxPolygonCorners = 1000;

/// The index that a face of a file gives, or Error naming the face when no such vertex exists.
unsigned checkedCorner(double index,
                       std::size_t vertex_count,
                       std::int64_t face,
                       const std::string& where);

/// Throws Error for a face of more than kMaxPolygonCorners.
void checkCornerCount(std::int64_t corners, std::int64_t face, const std::string& where);

/// Appends the triangles of a simple, nearly flat polygon (ear clipping), wound as the polygon is.
/// `corners` are indices into `vertices` and in range. Corners that leave no ear (a polygon that
/// crosses itself) are cut off one by one, so that n corners always give n - 2 triangles.
void appendTriangles(const std::vector<glm::dvec3>& vertices,
                     std::vector<unsigned> corners,
                     std::vector<glm::uvec3>& triangles);

}  // namespace rangepose
