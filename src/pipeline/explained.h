// Which pixels of the depth image the poses that were found explain.
#pragma once

#include <cstdint>

#include "core/camera.h"
#include "core/image.h"
#include "stages/reference.h"
#include "stages/stage_set.h"

namespace rangepose {

class ExplainedPixels {
 public:
  /// `depth` and `stages` must outlive it.
  ExplainedPixels(const DepthImage& depth, double noise_mm, StageSet& stages);

  /// Takes the pixels that the object explains in this pose, out of `foreground` too. False, and
  /// nothing is taken, where other poses explain more than a quarter of them: no surface belongs
  /// to two parts.
  bool take(const ReferenceObject& object, const Pose& pose, Image<std::uint8_t>& foreground);

 private:
  const DepthImage& depth_;
  double noise_mm_;
  StageSet& stages_;
  Image<std::uint8_t> taken_;
};

}  // namespace rangepose
