// How much of known surfaces a sensor does not measure, and in what steps it gives depth.
#pragma once

#include <array>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "eval/known_surface.h"

namespace rangepose {

struct LostShare {
  long long pixels = 0;
  long long lost = 0;

  void add(const LostShare& other);
  double share() const;  ///< 0..1; NaN without pixels
};

/// Pixels of counted parts that no nearer measurement hides.
struct LostTally {
  std::array<LostShare, 6> by_slant;  ///< inner ones, by the angle between normal and ray: 15 degrees each
  LostShare silhouettes;              ///< all of them

  void add(const LostTally& other);
};

LostTally tallyLost(const DepthImage& image,
                    const KnownSurface& known,
                    const std::vector<KnownPart>& parts);

/// Of the depth values of an image.
struct DepthSteps {
  /// Every value of the image is a multiple of so many stored units (scale of the camera); 0
  /// without values.
  long long common_units = 0;
  double unit_mm = 0.0;
  std::vector<float> gaps_mm;  ///< between neighbours among the values that occur on counted parts

  void add(const DepthSteps& other);
};

DepthSteps depthSteps(const DepthImage& image,
                      const KnownSurface& known,
                      const std::vector<KnownPart>& parts);

}  // namespace rangepose
