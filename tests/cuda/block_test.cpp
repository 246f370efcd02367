// The block of threads that runs on the host: the order of its sums is a contract.
#include "cuda/block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/range_scenes.h"

namespace rangepose::cuda {
namespace {

/// Pairs at distance 16, 8, ... by recursion: element `lane` after the steps down to `step`.
float treeSum(const std::vector<float>& values, std::size_t first, std::size_t lane, int step) {
  if (step == kWarp) return values[first + lane];
  return treeSum(values, first, lane, 2 * step) +
         treeSum(values, first, lane + static_cast<std::size_t>(step), 2 * step);
}

TEST(BlockTest, SumsAddPairsInWarpsThenWarps) {
  constexpr int kThreads = 96;
  test::Random random(3);
  HostBlock<kThreads>::PerThread<float> values;
  std::vector<float> copy;
  for (int i = 0; i < kThreads; ++i) {
    // Sizes so different that another order gives another sum.
    const double size = std::pow(10.0, random.uniform(-3.0, 5.0));
    copy.push_back(static_cast<float>(random.uniform(-size, size)));
    values[i] = copy.back();
  }
  float total = 0.0f;
  HostBlock<kThreads> block;
  block.sum<float>(values, [&](float sum) { total = sum; });
  const float expected = treeSum(copy, 0, 0, 1) + treeSum(copy, 32, 0, 1) + treeSum(copy, 64, 0, 1);
  EXPECT_EQ(total, expected);
  float in_line = 0.0f;
  for (const float value : copy) in_line += value;
  EXPECT_NE(total, in_line) << "the values do not show the order";
}

TEST(BlockTest, MembersAreAddedOneByOne) {
  struct Sums {
    double a;
    double b[2];
  };
  HostBlock<64> block;
  HostBlock<64>::PerThread<Sums> values;
  block.forEachThread([&](int thread) { values[thread] = {1.0, {2.0 * thread, -1.0 * thread}}; });
  Sums total{};
  block.sum<double>(values, [&](const Sums& sum) { total = sum; });
  EXPECT_EQ(total.a, 64.0);
  EXPECT_EQ(total.b[0], 64.0 * 63.0);
  EXPECT_EQ(total.b[1], -32.0 * 63.0);
}

TEST(BlockTest, ValuesOfAThreadLiveThroughPhases) {
  HostBlock<32> block;
  HostBlock<32>::PerThread<int> value;
  block.forEachThread([&](int thread) { value[thread] += thread; });
  block.barrier();
  block.forEachThread([&](int thread) { value[thread] *= 2; });
  block.forEachThread([&](int thread) { EXPECT_EQ(value[thread], 2 * thread); });
}

TEST(BlockTest, TheSmallestValueGoesToTheLeader) {
  HostBlock<64> block;
  HostBlock<64>::PerThread<int> value;
  for (const int where : {0, 31, 32, 63}) {
    block.forEachThread([&](int thread) { value[thread] = thread == where ? -7 : thread; });
    int least = 0;
    block.smallest(value, [&](int smallest) { least = smallest; });
    EXPECT_EQ(least, -7);
  }
}

}  // namespace
}  // namespace rangepose::cuda
