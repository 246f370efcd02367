#include "sampling/view_symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rangepose {
namespace {

glm::dvec3 anyPerpendicular(const glm::dvec3& v) {
  const glm::dvec3 other = std::abs(v.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(v, other));
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return 2.0 * std::atan2(glm::length(a - b), glm::length(a + b));
}

}  // namespace

glm::dmat3 shortestTurn(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 normal = glm::cross(from, to);
  const double sine = glm::length(normal);
  const double angle = angleBetween(from, to);
  const glm::dvec3 axis = sine > 1e-9 ? normal / sine : anyPerpendicular(from);
  return rotationFromVector(angle * axis);
}

ViewSymmetry::ViewSymmetry(const Symmetries& symmetries)
    : sphere_(symmetries.continuous.size() > 1),
      revolution_(symmetries.continuous.size() == 1),
      elements_{glm::dmat3(1.0)} {
  if (!revolution_) {
    for (const Pose& pose : symmetries.discrete) elements_.push_back(pose.rotation);
    return;
  }
  axis_ = glm::normalize(symmetries.continuous[0].direction);
  side_ = anyPerpendicular(axis_);
  // Of the discrete ones only those matter that turn the axis around.
  ends_alike_ =
      std::any_of(symmetries.discrete.begin(), symmetries.discrete.end(), [&](const Pose& pose) {
        return glm::dot(pose.rotation * axis_, axis_) < -0.5;
      });
  half_turn_ = rotationFromVector(std::numbers::pi * side_);
}

glm::dmat3 ViewSymmetry::folded(const glm::dmat3& rotation) const {
  if (!revolution_) return rotation;
  glm::dmat3 result = rotation;
  if (ends_alike_ && glm::dot(viewDirection(result), axis_) < 0.0) result = result * half_turn_;
  const glm::dvec3 direction = viewDirection(result);
  const glm::dvec3 across = direction - glm::dot(direction, axis_) * axis_;
  if (glm::length(across) < 1e-9) return result;
  // S^T turns the direction into the half-plane, about the axis.
  const double angle =
      std::atan2(glm::dot(glm::cross(axis_, side_), across), glm::dot(side_, across));
  return result * rotationFromVector(angle * axis_);
}

int ViewSymmetry::inPlaneCopies(const glm::dvec3& direction, double reach) const {
  if (revolution_) {
    // The half turn about the direction itself, where that is square to the axis.
    const double off = std::asin(std::clamp(std::abs(glm::dot(direction, axis_)), 0.0, 1.0));
    return ends_alike_ && 2.0 * off <= reach ? 2 : 1;
  }
  return static_cast<int>(
      std::count_if(elements_.begin(), elements_.end(), [&](const glm::dmat3& element) {
        return angleBetween(element * direction, direction) <= reach;
      }));
}

double ViewSymmetry::inPlaneEffect(const glm::dvec3& direction) const {
  return revolution_ ? glm::length(glm::cross(direction, axis_)) : 1.0;
}

}  // namespace rangepose
