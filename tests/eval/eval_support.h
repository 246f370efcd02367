// What the tests of src/eval share: parts with known symmetries, and poses.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "core/pose.h"
#include "geometry/mesh.h"
#include "geometry/symmetry.h"

namespace rangepose::test {

inline Pose randomPose(std::mt19937_64& random, double spread_mm = 100.0) {
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-52 - 1.0; };
  Pose pose;
  pose.rotation = rotationFromVector(3.0 * glm::dvec3(uniform(), uniform(), uniform()));
  pose.translation_mm = spread_mm * glm::dvec3(uniform(), uniform(), uniform());
  pose.translation_mm.z += 600.0;
  return pose;
}

/// The turn by `angle` about a line.
inline Pose turnAbout(const SymmetryAxis& axis, double angle) {
  Pose pose;
  pose.rotation = rotationFromVector(angle * axis.direction);
  pose.translation_mm = axis.point_mm - pose.rotation * axis.point_mm;
  return pose;
}

/// A cone with its tip cut off about a line parallel to z through (12, -5, 0): a solid of
/// revolution away from its frame's origin. Its vertices are not symmetric: 35 on one ring, 55 on
/// the other.
inline Mesh coneMesh() {
  Mesh mesh;
  mesh.name = "cone";
  const auto ring = [&mesh](unsigned count, double radius, double z) {
    for (unsigned i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / count;
      mesh.vertices.emplace_back(
          12.0 + radius * std::cos(angle), -5.0 + radius * std::sin(angle), z);
    }
  };
  constexpr unsigned kLow = 35;
  constexpr unsigned kHigh = 55;
  ring(kLow, 10.0, 0.0);
  ring(kHigh, 20.0, 50.0);
  for (unsigned low = 0, high = 0; low < kLow || high < kHigh;) {
    const unsigned a = low % kLow;
    const unsigned b = kLow + high % kHigh;
    if ((low + 1) * kHigh <= (high + 1) * kLow) {
      mesh.triangles.emplace_back(a, ++low % kLow, b);
    } else {
      mesh.triangles.emplace_back(kLow + ++high % kHigh, b, a);
    }
  }
  return mesh;
}

inline Symmetries coneSymmetries() {
  Symmetries symmetries;
  symmetries.continuous.push_back({{0.0, 0.0, 1.0}, {12.0, -5.0, 0.0}});
  return symmetries;
}

/// The half turns of a box about the three lines through its middle.
inline Symmetries halfTurns(const glm::dvec3& center) {
  Symmetries symmetries;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 direction(0.0);
    direction[axis] = 1.0;
    symmetries.discrete.push_back(turnAbout({direction, center}, std::numbers::pi));
  }
  return symmetries;
}

}  // namespace rangepose::test
