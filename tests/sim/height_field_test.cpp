#include "sim/height_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "sim_meshes.h"

namespace rangepose {
namespace {

TEST(HeightFieldTest, ColumnsOfABoxAreItsHeight) {
  const Mesh box = boxMesh({-10, -5, -3}, {10, 5, 3});
  const PartColumns columns = columnsOf(box, glm::dvec3(0.0), glm::dmat3(1.0), {100.0, -40.0}, 1.0);
  // One column of the box's border and one by widening on each side.
  EXPECT_EQ(columns.x0, 100 - 10 - 1);
  EXPECT_EQ(columns.y0, -40 - 5 - 1);
  for (int j = 1; j < columns.bottom.height() - 2; ++j) {
    for (int i = 1; i < columns.bottom.width() - 2; ++i) {
      ASSERT_EQ(columns.bottom.at(i, j), -3.0f) << i << " " << j;
      ASSERT_EQ(columns.top.at(i, j), 3.0f) << i << " " << j;
    }
  }
}

TEST(HeightFieldTest, CornerBetweenColumnCentresIsNotMissed) {
  const Mesh box = boxMesh({-8, -8, -8}, {8, 8, 8});
  const double a = std::sqrt(0.5);
  const double b = std::sqrt(1.0 / 3.0);
  // Stands on a corner: rows of the rotation are two level axes and the diagonal.
  const glm::dvec3 diagonal(b, b, b);
  const glm::dvec3 level(a, -a, 0.0);
  const glm::dmat3 rotation =
      glm::transpose(glm::dmat3(level, glm::cross(diagonal, level), diagonal));
  const PartColumns columns = columnsOf(box, glm::dvec3(0.0), rotation, {0.0, 0.0}, 2.0);
  const HeapTop table(50.0, 2.0);
  EXPECT_NEAR(table.restingHeight(columns), 8.0 * std::sqrt(3.0), 1e-4);
}

TEST(HeightFieldTest, PartsRestOnTableAndOnEachOther) {
  const Mesh box = boxMesh({-10, -5, -3}, {10, 5, 3});
  HeapTop heap(60.0, 0.5);
  const PartColumns first = columnsOf(box, glm::dvec3(0.0), glm::dmat3(1.0), {0.0, 0.0}, 0.5);
  EXPECT_FLOAT_EQ(static_cast<float>(heap.restingHeight(first)), 3.0f);
  heap.add(first, 3.0);
  EXPECT_EQ(heap.at(0, 0), 6.0f);
  EXPECT_EQ(heap.at(100, 100), 0.0f);
  const PartColumns over = columnsOf(box, glm::dvec3(0.0), glm::dmat3(1.0), {15.0, 0.0}, 0.5);
  EXPECT_FLOAT_EQ(static_cast<float>(heap.restingHeight(over)), 9.0f);
  const PartColumns beside = columnsOf(box, glm::dvec3(0.0), glm::dmat3(1.0), {23.0, 0.0}, 0.5);
  EXPECT_FLOAT_EQ(static_cast<float>(heap.restingHeight(beside)), 3.0f);
}

TEST(HeightFieldTest, PartBeyondTheExtentIsRefused) {
  const Mesh box = boxMesh({-10, -5, -3}, {10, 5, 3});
  HeapTop heap(20.0, 1.0);
  const PartColumns columns = columnsOf(box, glm::dvec3(0.0), glm::dmat3(1.0), {15.0, 0.0}, 1.0);
  EXPECT_THROW(heap.add(columns, 3.0), Error);
}

}  // namespace
}  // namespace rangepose
