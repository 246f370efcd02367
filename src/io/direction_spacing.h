// The spacing of scattered points of a plane.
#pragma once

#include <vector>

#include "core/glm.h"

namespace rangepose {

/// The median, over a sample of the points, of the distance to the third nearest other position. On
/// a square grid, also one with holes, that is its step; for points scattered at random it is about
/// the side of a square that holds one point. The nearest neighbour alone would give half of that.
/// 0 when there are fewer than four different positions nearby.
double typicalSpacing(const std::vector<glm::dvec2>& points);

}  // namespace rangepose
