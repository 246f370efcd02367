// Rotations spread evenly over SO(3).
#pragma once

#include <vector>

#include "core/glm.h"

namespace rangepose {

/// `count` rotations, evenly spread: super-Fibonacci spirals (Alexa, "Super-Fibonacci Spirals:
/// Fast, Low-Discrepancy Sampling of SO(3)", CVPR 2022). For 1,024 the largest distance of any
/// rotation to the nearest sample is about 23 degrees. The same count always gives the same
/// rotations.
std::vector<glm::dmat3> uniformRotations(int count);

}  // namespace rangepose
