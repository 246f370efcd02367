#include "geometry/rotation_group.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/pose.h"

namespace rangepose {
namespace {

constexpr double kSameRad = 1e-4;
constexpr std::size_t kLargestGroup = 1000;

bool contains(const std::vector<glm::dmat3>& group, const glm::dmat3& rotation) {
  return std::any_of(group.begin(), group.end(), [&](const glm::dmat3& element) {
    return rotationAngleBetween(element, rotation) < kSameRad;
  });
}

glm::dmat3 turnAbout(const glm::dvec3& axis, double angle) {
  return rotationFromVector(angle * glm::normalize(axis));
}

}  // namespace

glm::dmat3 turnAboutZ(double angle) { return turnAbout({0.0, 0.0, 1.0}, angle); }

std::vector<glm::dmat3> generatedGroup(const std::vector<glm::dmat3>& generators) {
  std::vector<glm::dmat3> group = {glm::dmat3(1.0)};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const glm::dmat3& generator : generators) {
      const glm::dmat3 product = orthonormalized(generator * group[i]);
      if (contains(group, product)) continue;
      RP_CHECK(group.size() < kLargestGroup, "rotation group: the generators make no finite group");
      group.push_back(product);
    }
  }
  return group;
}

std::vector<glm::dmat3> cyclicGroup(int order) {
  RP_CHECK(order >= 1, "rotation group: order must be at least 1");
  std::vector<glm::dmat3> group;
  group.reserve(static_cast<std::size_t>(order));
  for (int i = 0; i < order; ++i) group.push_back(turnAboutZ(2.0 * std::numbers::pi * i / order));
  return group;
}

std::vector<glm::dmat3> dihedralGroup(int order) {
  std::vector<glm::dmat3> group = cyclicGroup(order);
  const glm::dmat3 flip = turnAbout({1.0, 0.0, 0.0}, std::numbers::pi);
  for (int i = 0; i < order; ++i) group.push_back(group[static_cast<std::size_t>(i)] * flip);
  return group;
}

std::vector<glm::dmat3> tetrahedralGroup() {
  return generatedGroup({turnAbout({0.0, 0.0, 1.0}, std::numbers::pi),
                         turnAbout({1.0, 1.0, 1.0}, 2.0 * std::numbers::pi / 3.0)});
}

std::vector<glm::dmat3> octahedralGroup() {
  return generatedGroup({turnAbout({0.0, 0.0, 1.0}, 0.5 * std::numbers::pi),
                         turnAbout({1.0, 1.0, 1.0}, 2.0 * std::numbers::pi / 3.0)});
}

std::vector<glm::dmat3> icosahedralGroup() {
  return generatedGroup({turnAbout({0.0, 0.0, 1.0}, std::numbers::pi),
                         turnAbout({0.0, 1.0, std::numbers::phi}, 0.4 * std::numbers::pi)});
}

std::string groupName(std::size_t size, int largest_order) {
  const std::size_t order = static_cast<std::size_t>(largest_order);
  if (size <= 1) return "none";
  if (size == order) return std::string("C").append(std::to_string(order));
  if (size == 2 * order) return std::string("D").append(std::to_string(order));
  if (size == 12) return "T";
  if (size == 24) return "O";
  if (size == 60) return "I";
  return std::to_string(size) + " rotations";
}

int orderOf(const glm::dmat3& rotation, int limit) {
  glm::dmat3 power = rotation;
  for (int order = 1; order <= limit; ++order) {
    if (rotationAngleBetween(power, glm::dmat3(1.0)) < 1e-3) return order;
    power = orthonormalized(rotation * power);
  }
  return 0;
}

}  // namespace rangepose
