// Pose statistics by simulation: bins full of one part (paper Sect. 4.2).
#pragma once

#include <functional>

#include "geometry/mesh.h"
#include "sampling/pose_statistics.h"

namespace rangepose {

struct DropStatisticsOptions {
  int bins = 500;          ///< the paper: about 500
  int fewest_parts = 50;   ///< of a bin
  int most_parts = 80;     ///< of a bin; each number between is as likely
  std::uint64_t seed = 1;  ///< same seed, same statistics
  void check() const;      ///< throws Error naming the bad field
};

/// Drops the part bin by bin, on all cores; the result does not depend on how many there are. A bin
/// that does not come to rest is left out; throws Error when that happens to more than one in ten.
///
/// `progress` is called with the bins done, by any thread, one at a time. The mesh hash is left 0.
PoseStatistics simulateStatistics(const Mesh& mesh,
                                  const DropStatisticsOptions& options,
                                  const std::function<void(int done)>& progress);

}  // namespace rangepose
