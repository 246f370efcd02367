// A block whose threads are threads of the host: each runs the whole body by itself and meets the
// others at barriers, as on the device. Unlike HostBlock it shows a barrier that is missing (to
// -fsanitize=thread, and often in the result) or that not all threads come to (it hangs).
#pragma once

#include <barrier>
#include <thread>
#include <vector>

#include "cuda/block.h"

namespace rangepose::test {

template <int kThreadCount>
class ThreadedBlock {
 public:
  static constexpr int kThreads = kThreadCount;

  template <typename T>
  class PerThread {
   public:
    T& operator[](int) { return value_; }
    const T& own() const { return value_; }

   private:
    T value_{};
  };

  /// What the threads of a block have in common.
  struct Team {
    std::barrier<> meeting{kThreads};
    const void* values[kThreads] = {};
  };

  ThreadedBlock(Team& team, int thread) : team_(team), thread_(thread) {}

  template <typename Body>
  void forEachThread(const Body& body) {
    body(thread_);
  }
  template <typename Body>
  void leader(const Body& body) {
    if (thread_ == 0) body();
  }
  void barrier() { team_.meeting.arrive_and_wait(); }

  template <typename Number, typename Value, typename Body>
  void sum(PerThread<Value>& values, const Body& body) {
    gather<Value>(values, [&](auto& host, auto& all) { host.template sum<Number>(all, body); });
  }
  template <typename T, typename Body>
  void smallest(PerThread<T>& values, const Body& body) {
    gather<T>(values, [&](auto& host, auto& all) { host.smallest(all, body); });
  }

 private:
  /// Barriers where the device has them: before the leader reads what all have, and after its turn.
  template <typename Value, typename Reduce>
  void gather(const PerThread<Value>& values, const Reduce& reduce) {
    team_.values[thread_] = &values.own();
    barrier();
    if (thread_ == 0) {
      cuda::HostBlock<kThreads> host;
      typename cuda::HostBlock<kThreads>::template PerThread<Value> all;
      for (int i = 0; i < kThreads; ++i) all[i] = *static_cast<const Value*>(team_.values[i]);
      reduce(host, all);
    }
    barrier();
  }

  Team& team_;
  int thread_;
};

/// Calls `body(block)` in each thread of a block.
template <int kThreads, typename Body>
void runThreaded(const Body& body) {
  typename ThreadedBlock<kThreads>::Team team;
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&team, &body, i] {
      ThreadedBlock<kThreads> block(team, i);
      body(block);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace rangepose::test
