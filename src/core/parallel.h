// Data-parallel loops on the host. Work is cut into fixed pieces that do not depend on the number
// of threads, so that a result never does.
#pragma once

#include <cstddef>
#include <functional>

namespace rangepose {

/// Calls body(begin, end) for consecutive pieces of at most `grain` indices of [0, count), in any
/// order and at the same time. An exception thrown by a piece is rethrown here.
void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body);

/// Calls body(i) for each index of [0, count), `grain` in a piece, likewise.
template <typename Body>
void parallelForEach(std::size_t count, int grain, const Body& body) {
  parallelFor(static_cast<int>(count), grain, [&body](int begin, int end) {
    for (int i = begin; i < end; ++i) body(static_cast<std::size_t>(i));
  });
}

/// Limits the threads of parallelFor in this process; 0 means all cores. Results do not change.
void setThreadCount(int threads);

}  // namespace rangepose
