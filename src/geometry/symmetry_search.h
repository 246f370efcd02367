// Rotations that might turn a surface onto itself: a coarse search over all rotations.
#pragma once

#include <vector>

#include "geometry/surface_match.h"

namespace rangepose {

/// Rotations about `centre_mm` at which the mean distance of the turned surface to itself has a low
/// minimum, accurate to some degrees, the best first. The identity and its neighbourhood are left
/// out. Of many equally good ones (a solid of revolution) only some are given.
std::vector<glm::dmat3> findRoughSymmetries(const SurfaceMatch& surface,
                                            const glm::dvec3& centre_mm,
                                            double radius_mm,
                                            double reach_mm);

}  // namespace rangepose
