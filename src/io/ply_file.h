// Vertices and faces of PLY files, ASCII and binary of both byte orders.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/glm.h"
#include "io/polygon.h"

namespace rangepose {

struct PlyVertices {
  std::vector<glm::dvec3> points;  ///< in the unit of the file; may be NaN
  int grid_width = 0;              ///< of an organised scan, 0 otherwise
  int grid_height = 0;             ///< likewise; grid_width * grid_height == points.size()
};

/// x, y and z of the element "vertex"; everything else is skipped. A scan is organised when
/// num_cols and num_rows (obj_info or comment lines) multiply to the number of vertices.
PlyVertices parsePlyVertices(std::string_view bytes, const std::string& where);

/// Also reads the lists vertex_indices (or vertex_index) of the element "face"; without that
/// element the mesh has no triangles. Throws Error for a face that names a vertex that does not
/// exist, and for more than kMaxMeshFaces faces.
RawMesh parsePlyMesh(std::string_view bytes, const std::string& where);

}  // namespace rangepose
