#include "core/parallel.h"

#include <algorithm>
#include <memory>

#include "core/error.h"

#ifdef RP_HAVE_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#else
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace rangepose {

#ifdef RP_HAVE_TBB

void parallelFor(int count, int grain, const std::function<void(int, int)>& body) {
  RP_CHECK(grain >= 1, "parallelFor: grain must be at least 1");
  const int pieces = (count + grain - 1) / grain;
  tbb::parallel_for(tbb::blocked_range<int>(0, pieces, 1),
                    [&](const tbb::blocked_range<int>& range) {
                      for (int piece = range.begin(); piece < range.end(); ++piece) {
                        body(piece * grain, std::min(count, (piece + 1) * grain));
                      }
                    });
}

void setThreadCount(int threads) {
  static std::unique_ptr<tbb::global_control> control;
  control.reset();
  if (threads > 0) {
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(threads));
  }
}

#else

namespace {
std::atomic<int> thread_limit{0};
}

void parallelFor(int count, int grain, const std::function<void(int, int)>& body) {
  RP_CHECK(grain >= 1, "parallelFor: grain must be at least 1");
  const int pieces = (count + grain - 1) / grain;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int limit = thread_limit > 0 ? thread_limit.load() : cores;
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (int piece = next++; piece < pieces; piece = next++) {
      try {
        body(piece * grain, std::min(count, (piece + 1) * grain));
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < std::min(limit, pieces); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

void setThreadCount(int threads) { thread_limit = threads; }

#endif

}  // namespace rangepose
