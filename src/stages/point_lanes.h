// Points and the depth image as the host reads them: eight at a time.
#pragma once

#include <cstring>
#include <vector>

#include "stages/posed_points_core.h"

namespace rangepose::host {

/// Up to eight points, the others are not wanted. As plain numbers: what alignment a vector has
/// depends on the processor that code is compiled for.
class EightPoints {
 public:
  bool full() const { return count_ == kLanes; }
  void add(const SurfacePoint& point) {
    wanted_[count_] = -1;
    for (int k = 0; k < 3; ++k) {
      numbers_[k][count_] = point.position_mm[k];
      numbers_[3 + k][count_] = point.normal[k];
    }
    ++count_;
  }
  RP_ALWAYS_INLINE PointsOf<Float8> loaded() const {
    const auto& n = numbers_;
    Int8 wanted;
    std::memcpy(&wanted, wanted_, sizeof wanted);
    return {
        wanted, {load8(n[0]), load8(n[1]), load8(n[2])}, {load8(n[3]), load8(n[4]), load8(n[5])}};
  }

 private:
  int count_ = 0;
  int wanted_[kLanes] = {};        ///< all bits or none
  float numbers_[6][kLanes] = {};  ///< x, y, z of the position [mm] and of the normal
};

inline void append(std::vector<EightPoints>& blocks, const SurfacePoint& point) {
  if (blocks.empty() || blocks.back().full()) blocks.emplace_back();
  blocks.back().add(point);
}

/// See posed_points_core.h.
struct DepthPixels {
  const float* depth_mm;
  int width;

  RP_LANES Float8 operator()(const Int8& where, const Int8& u, const Int8& v) const {
    const Int8 index = pick(where, v * width + u, Int8{});
    Float8 depth;
    for (int i = 0; i < kLanes; ++i) depth[i] = depth_mm[index[i]];
    return pick(where, depth, Float8{});
  }
  float operator()(bool where, int u, int v) const {
    return where ? depth_mm[v * width + u] : 0.0f;
  }
};

}  // namespace rangepose::host
