// Mesh files in, PLY out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "geometry/mesh.h"
#include "io/length_unit.h"

namespace rangepose {

/// Largest number of triangles of a mesh file.
inline constexpr std::size_t kMaxMeshFaces = 20'000'000;

/// Throws Error naming `where` for more than kMaxMeshFaces.
void checkFaceCount(std::size_t faces, const std::string& where);

/// Reads PLY and OFF, and by assimp STL, OBJ, glTF/GLB and what else it knows.
/// All meshes of the scene are joined into one, moved by the transforms of their nodes; equal
/// positions become one vertex, triangles without area are removed, and the name is the stem of the
/// file.
///
/// Mesh files carry no unit: `unit` decides for every format. glTF is in metres by its
/// specification, yet many exporters write the numbers of the CAD system as they are, so there is
/// no exception for it.
///
/// Throws Error for a missing, empty, truncated or oversized file, one of another type, one without
/// faces (point cloud), and for bad indices. Formats that are lists of independent lines (OBJ)
/// cannot tell a file that was cut between two faces.
Mesh readMesh(const std::filesystem::path& path, LengthUnit unit);

/// Binary little endian PLY in millimetres, whole or not at all.
void writePly(const std::filesystem::path& path, const Mesh& mesh);

/// 64-bit FNV-1a over the counts, vertices and triangles (little endian, in order); the name is
/// left out.
std::uint64_t meshHash(const Mesh& mesh);

}  // namespace rangepose
