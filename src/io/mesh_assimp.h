// The boundary to assimp.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/mesh.h"

namespace rangepose {

/// Triangles of all meshes of a scene file, in the unit of the file times `scale`. Vertices are not
/// joined and nothing is checked but the number of faces. Throws Error naming `where`.
Mesh importScene(const std::filesystem::path& path, double scale, const std::string& where);

}  // namespace rangepose
