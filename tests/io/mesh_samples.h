// Meshes for the tests, as text and bytes of each format: a tetrahedron of volume 1.
#pragma once

#include <string>

#include "geometry/mesh.h"

namespace rangepose::test {

/// Right angles at the origin and legs of 1, 2 and 3, wound outwards.
Mesh tetrahedron();

std::string binaryStl(const Mesh& mesh);
std::string asciiStl(const Mesh& mesh);

inline constexpr const char* kObj =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
inline constexpr const char* kOff =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
inline constexpr const char* kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
inline constexpr const char* kPlyVertices = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n";
inline constexpr const char* kPlyFaces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

}  // namespace rangepose::test
