// The finite groups of rotations, each in a frame of its own.
#pragma once

#include <string>
#include <vector>

#include "core/glm.h"

namespace rangepose {

/// The rotation about z by `angle` [rad].
glm::dmat3 turnAboutZ(double angle);

/// All products of the generators, the identity first. Throws Error for more than 1,000.
std::vector<glm::dmat3> generatedGroup(const std::vector<glm::dmat3>& generators);

/// C_n: about z.
std::vector<glm::dmat3> cyclicGroup(int order);
/// D_n: about z, and half turns about x and its turned copies.
std::vector<glm::dmat3> dihedralGroup(int order);
/// T, 12 rotations: half turns about x, y and z, third turns about the diagonals.
std::vector<glm::dmat3> tetrahedralGroup();
/// O, 24 rotations: quarter turns about x, y and z.
std::vector<glm::dmat3> octahedralGroup();
/// I, 60 rotations: half turns about x, y and z, fifth turns about (0, 1, golden ratio).
std::vector<glm::dmat3> icosahedralGroup();

/// "none", "C3", "D6", "T", "O" or "I" of a closed group of `size` rotations whose elements have at
/// most `largest_order`.
std::string groupName(std::size_t size, int largest_order);

/// How often a rotation must be repeated to come back to the identity; 0 when more than `limit`.
int orderOf(const glm::dmat3& rotation, int limit);

}  // namespace rangepose
