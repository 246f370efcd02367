// Start points of the search (paper Sect. 5.3, 6.1).
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "stages/scene_channels.h"

namespace rangepose {

struct SeedOptions {
  int count = 3;          ///< starts wanted (N_init)
  int min_patch_px = 20;  ///< smaller patches come after the first starts of all larger ones
  int max_patch_px =
      100000;           ///< a larger patch shows several parts that touch: it gets several starts
  float apart_px = 30;  ///< distance of the starts in such a patch [px]
  float min_distance_px = 2;  ///< the same for patches whose largest EDT value is smaller
};

/// The most inner pixel (largest EDT value; on a tie the one nearest to the middle of the tied
/// ones) of each patch, those with the smallest mean range first.
///
/// Differs from the paper: where parts touch without a jump in depth, one patch covers them all,
/// and its most inner pixel is one start for many parts. A patch larger than any view of the object
/// therefore gets further starts, each the most inner pixel farther than apart_px from the ones
/// before; they come after the first starts of all patches, in turn with small patches that are
/// farther than apart_px from all starts, the largest first.
std::vector<Seed> findSeeds(const SceneChannels& scene,
                            const Image<std::int32_t>& labels,
                            const SeedOptions& options);

}  // namespace rangepose
