// Symmetries about the origin, without a mesh.
#pragma once

#include <numbers>
#include <vector>

#include "core/pose.h"
#include "geometry/rotation_group.h"
#include "geometry/symmetry.h"

namespace rangepose::test {

/// `turn` shifts the group out of its own frame.
inline Symmetries finite(const std::vector<glm::dmat3>& group,
                         const glm::dmat3& turn = glm::dmat3(1.0)) {
  Symmetries symmetries;
  for (std::size_t i = 1; i < group.size(); ++i) {
    symmetries.discrete.push_back({turn * group[i] * glm::transpose(turn), glm::dvec3(0.0)});
  }
  return symmetries;
}

inline Symmetries revolution(const glm::dvec3& axis, bool ends_alike) {
  Symmetries symmetries;
  symmetries.continuous.push_back({glm::normalize(axis), glm::dvec3(0.0)});
  if (ends_alike) {
    const glm::dvec3 across = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 0.8, -0.1)));
    symmetries.discrete.push_back({rotationFromVector(std::numbers::pi * across), {}});
  }
  return symmetries;
}

inline Symmetries sphere() {
  return {{},
          {{{1.0, 0.0, 0.0}, glm::dvec3(0.0)},
           {{0.0, 1.0, 0.0}, glm::dvec3(0.0)},
           {{0.0, 0.0, 1.0}, glm::dvec3(0.0)}}};
}

inline glm::dmat3 anyTurn() { return rotationFromVector({0.3, 1.1, -0.7}); }

}  // namespace rangepose::test
