// Start points of the search (paper Sect. 5.3, 6.1).
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "stages/scene_channels.h"

namespace rangepose {

struct SeedOptions {
  int count = 3;             ///< starts wanted (N_init)
  int min_patch_px = 20;     ///< smaller patches are dropped, unless there are no larger ones
  float min_distance_px = 2; ///< the same for patches whose largest EDT value is smaller
};

/// The most inner pixel (largest EDT value; on a tie the one nearest to the middle of the tied ones) of each
/// patch, patches with the smallest mean range first.
std::vector<Seed> findSeeds(const SceneChannels& scene,
                            const Image<std::int32_t>& labels,
                            const SeedOptions& options);

}  // namespace rangepose
