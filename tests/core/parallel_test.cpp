// Loops over threads: a lost index is a view that is never tried, a repeated one a race.
#include "core/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <vector>

#include "core/error.h"

namespace rangepose {
namespace {

class ParallelTest : public testing::Test {
 protected:
  ~ParallelTest() override { setThreadCount(0); }
};

TEST_F(ParallelTest, EveryIndexIsVisitedOnce) {
  for (const int threads : {0, 1, 2, 5}) {
    setThreadCount(threads);
    for (const int count : {0, 1, 7, 64, 1000}) {
      for (const int grain : {1, 3, 64, 2000}) {
        std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
        parallelFor(count, grain, [&](int begin, int end) {
          EXPECT_LT(begin, end);
          for (int i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
        });
        for (const std::atomic<int>& visit : visits) ASSERT_EQ(visit, 1);
      }
    }
  }
}

TEST_F(ParallelTest, PiecesDoNotDependOnTheNumberOfThreads) {
  std::vector<std::set<std::pair<int, int>>> cuts;
  for (const int threads : {1, 2, 4}) {
    setThreadCount(threads);
    std::set<std::pair<int, int>> pieces;
    std::mutex mutex;
    parallelFor(103, 10, [&](int begin, int end) {
      const std::lock_guard<std::mutex> lock(mutex);
      pieces.emplace(begin, end);
    });
    cuts.push_back(pieces);
  }
  EXPECT_EQ(cuts[0].size(), 11U);
  EXPECT_EQ(*cuts[0].rbegin(), std::make_pair(100, 103));
  EXPECT_EQ(cuts[1], cuts[0]);
  EXPECT_EQ(cuts[2], cuts[0]);
}

TEST_F(ParallelTest, SumsOfPiecesAreBitIdenticalForEveryNumberOfThreads) {
  const auto total = [] {
    std::vector<float> sums(32, 0.0f);
    parallelFor(1000, 32, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        sums[static_cast<std::size_t>(begin / 32)] += std::sin(static_cast<float>(i));
      }
    });
    float sum = 0.0f;
    for (const float piece : sums) sum += piece;
    return sum;
  };
  setThreadCount(1);
  const float expected = total();
  for (const int threads : {2, 3, 8, 0}) {
    setThreadCount(threads);
    EXPECT_EQ(total(), expected) << threads;
  }
}

TEST_F(ParallelTest, AnErrorInAPieceReachesTheCaller) {
  for (const int threads : {1, 4}) {
    setThreadCount(threads);
    try {
      parallelFor(100, 1, [](int begin, int) {
        if (begin == 41) throw Error("view 41 is empty");
      });
      FAIL() << "the error was swallowed";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "view 41 is empty");
    }
    std::atomic<int> visited = 0;
    parallelFor(100, 7, [&](int begin, int end) { visited += end - begin; });
    EXPECT_EQ(visited, 100) << "the loop after a failed one must work";
  }
}

TEST(ErrorTest, ChecksSayWhatDoesNotHold) {
  const int views = 0;
  try {
    RP_CHECK(views > 0, "no views");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no views"));
    EXPECT_THAT(error.what(), testing::HasSubstr("views > 0"));
  }
  EXPECT_THROW(throw Unavailable("no EGL"), Error);
}

}  // namespace
}  // namespace rangepose
