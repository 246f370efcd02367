// What follows from the symmetries of a part.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "geometry/orientation_grid.h"
#include "geometry/rotation_group.h"
#include "geometry/symmetry.h"

namespace rangepose {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostOfSphere = 4096.0;

Pose aboutPoint(const glm::dmat3& rotation, const glm::dvec3& point) {
  return {rotation, point - rotation * point};
}

std::vector<Pose> roundPoses(const Symmetries& symmetries, double angle_rad) {
  const SymmetryAxis& axis = symmetries.continuous.front();
  std::vector<Pose> poses;
  if (symmetries.continuous.size() > 1) {
    // Neighbours of n even rotations are about (8 pi^2 / n)^(1/3) rad apart.
    const double count = std::min(kMostOfSphere, 8.0 * kPi * kPi / std::pow(angle_rad, 3.0));
    poses.emplace_back();
    const glm::dvec3 centre = fixedPoint(symmetries.continuous, axis.point_mm);
    for (const glm::dmat3& rotation : uniformRotations(std::max(1, static_cast<int>(count)))) {
      poses.push_back(aboutPoint(rotation, centre));
    }
    return poses;
  }
  const int count = std::max(2, static_cast<int>(std::ceil(2.0 * kPi / angle_rad)));
  for (int i = 0; i < count; ++i) {
    poses.push_back(
        aboutPoint(rotationFromVector(2.0 * kPi * i / count * axis.direction), axis.point_mm));
  }
  return poses;
}

/// The smallest angle of `turn` * (any turn about `axis`): that between the axis and its image.
double angleBesideAxis(const glm::dmat3& turn, const glm::dvec3& axis) {
  const glm::dvec3 image = turn * axis;
  return 2.0 * std::atan2(glm::length(image - axis), glm::length(image + axis));
}

}  // namespace

std::string symmetryName(const Symmetries& symmetries) {
  if (symmetries.continuous.size() > 1) return "sphere";
  if (!symmetries.continuous.empty()) {
    return symmetries.discrete.empty() ? "revolution" : "revolution, ends alike";
  }
  const int size = static_cast<int>(symmetries.discrete.size()) + 1;
  int largest = 1;
  for (const Pose& pose : symmetries.discrete) {
    largest = std::max(largest, orderOf(pose.rotation, size));
  }
  return groupName(symmetries.discrete.size() + 1, largest);
}

glm::dvec3 fixedPoint(const std::vector<SymmetryAxis>& axes, const glm::dvec3& near_mm) {
  // The least sum of squared distances to the axes, and, where these leave it open, to `near_mm`.
  constexpr double kPull = 1e-9;
  glm::dmat3 matrix(kPull);
  glm::dvec3 right(0.0);
  for (const SymmetryAxis& axis : axes) {
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(axis.direction, axis.direction);
    matrix += across;
    right += across * (axis.point_mm - near_mm);
  }
  return near_mm + glm::inverse(matrix) * right;
}

std::vector<Pose> symmetricPoses(const Symmetries& symmetries, double radius_mm, double step_mm) {
  RP_CHECK(radius_mm > 0.0 && step_mm > 0.0, "symmetric poses: radius and step must be positive");
  std::vector<Pose> discrete = {Pose{}};
  discrete.insert(discrete.end(), symmetries.discrete.begin(), symmetries.discrete.end());
  if (symmetries.continuous.empty()) return discrete;
  const std::vector<Pose> round = roundPoses(symmetries, step_mm / radius_mm);
  std::vector<Pose> poses;
  poses.reserve(discrete.size() * round.size());
  for (const Pose& first : discrete) {
    for (const Pose& second : round) poses.push_back(first * second);
  }
  return poses;
}

double rotationAngleModulo(const Symmetries& symmetries, const glm::dmat3& a, const glm::dmat3& b) {
  if (symmetries.continuous.size() > 1) return 0.0;
  const glm::dmat3 turn = glm::transpose(a) * b;
  const auto angle = [&](const glm::dmat3& rotation) {
    if (symmetries.continuous.empty()) return rotationAngleBetween(rotation, glm::dmat3(1.0));
    return angleBesideAxis(rotation, symmetries.continuous.front().direction);
  };
  double smallest = angle(turn);
  for (const Pose& pose : symmetries.discrete) {
    smallest = std::min(smallest, angle(turn * pose.rotation));
  }
  return smallest;
}

}  // namespace rangepose
