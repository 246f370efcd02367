// The finite groups have the size, the orders and the closure that make them what they are.
#include "geometry/rotation_group.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/pose.h"

namespace rangepose {
namespace {

struct Expected {
  std::vector<glm::dmat3> group;
  std::size_t size;
  std::vector<int> elements_of_order;  ///< index: order
  std::string name;
};

std::vector<Expected> groups() {
  return {{cyclicGroup(1), 1, {0, 1}, "none"},
          {cyclicGroup(5), 5, {0, 1, 0, 0, 0, 4}, "C5"},
          {dihedralGroup(2), 4, {0, 1, 3}, "D2"},
          {dihedralGroup(3), 6, {0, 1, 3, 2}, "D3"},
          {dihedralGroup(6), 12, {0, 1, 7, 2, 0, 0, 2}, "D6"},
          {tetrahedralGroup(), 12, {0, 1, 3, 8}, "T"},
          {octahedralGroup(), 24, {0, 1, 9, 8, 6}, "O"},
          {icosahedralGroup(), 60, {0, 1, 15, 20, 0, 24}, "I"}};
}

TEST(RotationGroupTest, HasTheRightElements) {
  for (const Expected& expected : groups()) {
    ASSERT_EQ(expected.group.size(), expected.size) << expected.name;
    std::vector<int> found(expected.elements_of_order.size(), 0);
    for (const glm::dmat3& element : expected.group) {
      EXPECT_NEAR(glm::determinant(element), 1.0, 1e-12);
      const int order = orderOf(element, 60);
      ASSERT_LT(static_cast<std::size_t>(order), found.size()) << expected.name;
      ++found[static_cast<std::size_t>(order)];
    }
    EXPECT_EQ(found, expected.elements_of_order) << expected.name;
    const int largest = static_cast<int>(expected.elements_of_order.size()) - 1;
    EXPECT_EQ(groupName(expected.size, largest), expected.name);
  }
}

TEST(RotationGroupTest, IsClosed) {
  for (const Expected& expected : groups()) {
    for (const glm::dmat3& a : expected.group) {
      for (const glm::dmat3& b : expected.group) {
        EXPECT_TRUE(
            std::any_of(expected.group.begin(),
                        expected.group.end(),
                        [&](const glm::dmat3& c) { return rotationAngleBetween(a * b, c) < 1e-9; }))
            << expected.name;
      }
    }
  }
}

TEST(RotationGroupTest, RefusesGeneratorsWithoutEnd) {
  EXPECT_THROW(generatedGroup({turnAboutZ(2.0 * std::numbers::pi / std::numbers::phi)}), Error);
  EXPECT_THROW(cyclicGroup(0), Error);
  EXPECT_EQ(orderOf(turnAboutZ(1.0), 20), 0);
}

}  // namespace
}  // namespace rangepose
