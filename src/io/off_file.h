// OFF meshes (text).
#pragma once

#include <string>
#include <string_view>

#include "io/polygon.h"

namespace rangepose {

/// OFF with or without normals and colours, which are skipped. Each vertex and each face is a line
/// of its own. Throws Error naming `where`, also for a face that names a vertex that does not
/// exist.
RawMesh parseOffMesh(std::string_view bytes, const std::string& where);

}  // namespace rangepose
