// Data-parallel loops on the host. Work is cut into fixed pieces that do not depend on the number
// of threads, so that a result never does.
#pragma once

#include <functional>

namespace rangepose {

/// Calls body(begin, end) for consecutive pieces of at most `grain` indices of [0, count), in any
/// order and at the same time. An exception thrown by a piece is rethrown here.
void parallelFor(int count, int grain, const std::function<void(int begin, int end)>& body);

/// Limits the threads of parallelFor in this process; 0 means all cores. Results do not change.
void setThreadCount(int threads);

}  // namespace rangepose
