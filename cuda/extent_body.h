// The extent of a foreground on the device (see host::extentOf): the smallest of numbers does not
// depend on the order they come in.
#pragma once

#include <cstring>

#include "core/camera.h"
#include "cuda/block.h"

namespace rangepose::cuda {

/// Orders doubles like their values do, but for 0 and -0.
RP_HD unsigned long long orderedKey(double value) {
  constexpr unsigned long long kSign = 1ULL << 63;
  unsigned long long bits;
  memcpy(&bits, &value, sizeof bits);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}
RP_HD double valueOfKey(unsigned long long key) {
  constexpr unsigned long long kSign = 1ULL << 63;
  const unsigned long long bits = (key & kSign) != 0 ? key & ~kSign : ~key;
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/// Smallest x, y, -x and -y of the points of a part of an image. `depth_mm`: 0 where nothing is.
/// `lower(k, key)` must keep the smallest key of each.
template <typename Block, typename Lower>
RP_BODY void extentOfPart(Block& block,
                          const Camera& camera,
                          const float* depth_mm,
                          int part,
                          int parts,
                          const Lower& lower) {
  typename Block::template PerThread<double> least[4];
  block.forEachThread([&](int thread) {
    double own[4];
    for (double& one : own) one = 1.7976931348623157e308;
    const int pixels = camera.width * camera.height;
    for (int i = part * Block::kThreads + thread; i < pixels; i += parts * Block::kThreads) {
      if (depth_mm[i] == 0.0f) continue;
      const glm::dvec3 point =
          camera.unproject(i % camera.width, i / camera.width, static_cast<double>(depth_mm[i]));
      const double numbers[4] = {point.x, point.y, -point.x, -point.y};
      for (int k = 0; k < 4; ++k) own[k] = numbers[k] < own[k] ? numbers[k] : own[k];
    }
    for (int k = 0; k < 4; ++k) least[k][thread] = own[k];
  });
  for (int k = 0; k < 4; ++k)
    block.smallest(least[k], [&](double value) { lower(k, orderedKey(value)); });
}

}  // namespace rangepose::cuda
