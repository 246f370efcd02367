// Parts that fall come to lie as gravity wants.
#include "sampling/drop_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/pose.h"
#include "sampling/view_symmetry.h"
#include "support/box_mesh.h"

namespace rangepose {
namespace {

DropStatisticsOptions fewBins() {
  DropStatisticsOptions options;
  options.bins = 3;
  options.fewest_parts = 6;
  options.most_parts = 9;
  return options;
}

Mesh flatBox() { return test::meshOf({test::Box{{0, 0, 0}, {40, 30, 5}}}); }

TEST(DropStatisticsTest, FlatPartsLieFlat) {
  const PoseStatistics statistics = simulateStatistics(flatBox(), fewBins(), {});
  EXPECT_EQ(statistics.bins, 3);
  EXPECT_GE(statistics.parts, 18);
  EXPECT_LE(statistics.parts, 27);
  ASSERT_EQ(statistics.rotations.size(), static_cast<std::size_t>(statistics.parts));
  int flat = 0;
  for (const glm::dmat3& rotation : statistics.rotations) {
    EXPECT_NEAR(glm::determinant(rotation), 1.0, 1e-9);
    if (std::abs(viewDirection(rotation).z) > std::cos(0.6)) ++flat;
  }
  // An even spread would have 17 % of them within 34 degrees.
  EXPECT_GT(flat, statistics.parts * 6 / 10);
}

TEST(DropStatisticsTest, SameSeedSameStatisticsWithAnyNumberOfThreads) {
  setThreadCount(1);
  const PoseStatistics one = simulateStatistics(flatBox(), fewBins(), {});
  setThreadCount(0);
  const PoseStatistics all = simulateStatistics(flatBox(), fewBins(), {});
  EXPECT_EQ(one.rotations, all.rotations);
  DropStatisticsOptions other = fewBins();
  other.seed = 2;
  EXPECT_NE(one.rotations, simulateStatistics(flatBox(), other, {}).rotations);
}

TEST(DropStatisticsTest, ReportsEachBin) {
  int calls = 0;
  int last = 0;
  simulateStatistics(flatBox(), fewBins(), [&](int done) {
    ++calls;
    EXPECT_EQ(done, last + 1);
    last = done;
  });
  EXPECT_EQ(calls, 3);
}

TEST(DropStatisticsTest, RefusesBadOptions) {
  DropStatisticsOptions options;
  options.bins = 0;
  EXPECT_THROW(simulateStatistics(flatBox(), options, {}), Error);
  options = {};
  options.fewest_parts = 9;
  options.most_parts = 8;
  EXPECT_THROW(simulateStatistics(flatBox(), options, {}), Error);
}

}  // namespace
}  // namespace rangepose
