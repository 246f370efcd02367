// Points of views travel to the device once. Were they mixed up, poses would be aligned with the
// points of another view.
#include "cuda/point_places.h"

#include <gtest/gtest.h>

#include "stages/stage_set.h"

namespace rangepose {
namespace {

using Points = std::vector<SurfacePoint>;

Points numbered(int first, int count) {
  Points points(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    points[static_cast<std::size_t>(i)].position_mm.x = static_cast<float>(first + i);
  return points;
}

class PointPlacesTest : public testing::Test {
 protected:
  /// The first number of the points is their name.
  JudgeTask task(const Points& points, bool kept) {
    JudgeTask made;
    made.points = &points;
    if (kept) made.name = points.empty() ? 1 : static_cast<std::uint64_t>(points[0].position_mm.x);
    return made;
  }
  /// What the device would read there.
  void expectPlaced(const std::vector<JudgeTask>& tasks) {
    const std::vector<int> first = places_.place(tasks);
    Points array = places_.kept();
    array.insert(array.end(), places_.others().begin(), places_.others().end());
    ASSERT_EQ(first.size(), tasks.size());
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const Points& points = *tasks[i].points;
      ASSERT_LE(static_cast<std::size_t>(first[i]) + points.size(), array.size());
      for (std::size_t k = 0; k < points.size(); ++k) {
        EXPECT_EQ(array[static_cast<std::size_t>(first[i]) + k].position_mm.x,
                  points[k].position_mm.x)
            << "task " << i << ", point " << k;
      }
    }
  }

  cuda::PointPlaces places_;
  Points a_ = numbered(100, 3);
  Points b_ = numbered(200, 5);
  Points c_ = numbered(300, 2);
  Points none_;
};

TEST_F(PointPlacesTest, KeptPointsComeFirstAndOnce) {
  expectPlaced({task(a_, true), task(c_, false), task(b_, true), task(a_, true)});
  EXPECT_EQ(places_.kept().size(), 8u);
  EXPECT_EQ(places_.others().size(), 2u);
}

TEST_F(PointPlacesTest, KeptPointsStayWhereTheyAre) {
  expectPlaced({task(a_, true), task(c_, false)});
  const int before = places_.place(std::vector{task(a_, true)}).front();
  expectPlaced({task(b_, true), task(none_, true), task(c_, false), task(a_, true)});
  EXPECT_EQ(places_.place(std::vector{task(a_, true)}).front(), before);
  EXPECT_EQ(places_.kept().size(), 8u);
}

/// Points made for one call may lie at the address of others that are gone.
TEST_F(PointPlacesTest, OtherPointsAreReadAnew) {
  expectPlaced({task(a_, true), task(c_, false)});
  c_ = numbered(400, 4);
  expectPlaced({task(c_, false), task(a_, true)});
  EXPECT_EQ(places_.others().size(), 4u);
}

/// A program that runs for weeks reads many databases: what was kept of the first ones must go.
TEST_F(PointPlacesTest, PlacesAreGivenAnewWhenThereAreTooMany) {
  places_ = cuda::PointPlaces(7);
  expectPlaced({task(a_, true), task(b_, true)});
  EXPECT_EQ(places_.kept().size(), 8u);
  EXPECT_EQ(places_.unmoved(), 0u);
  expectPlaced({task(c_, true)});
  EXPECT_EQ(places_.kept().size(), 2u);
  EXPECT_EQ(places_.unmoved(), 0u);
  expectPlaced({task(b_, true), task(c_, true)});
  EXPECT_EQ(places_.kept().size(), 7u);
  EXPECT_EQ(places_.unmoved(), 2u);
}

}  // namespace
}  // namespace rangepose
