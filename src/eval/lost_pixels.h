// How much of known surfaces a sensor does not measure, and in what steps it gives depth.
#pragma once

#include <array>
#include <map>
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
  /// Inner ones, by the angle between normal and ray, 15 degrees each.
  std::array<LostShare, 6> by_slant;
  LostShare silhouettes;  ///< all of them

  void add(const LostTally& other);
};

LostTally tallyLost(const DepthImage& image,
                    const KnownSurface& known,
                    const std::vector<KnownPart>& parts);

/// Of the depth values of images.
struct DepthSteps {
  std::map<long long, long long> counts;  ///< by depth [um]
  std::vector<float> gaps_mm;  ///< between neighbours among the values of an image on counted parts

  void add(const DepthSteps& other);
  /// The largest step of which 95 % of the depth values are multiples, up to 10 mm; 0.001 mm where
  /// there is none, NaN without values.
  double commonStepMm() const;
};

DepthSteps depthSteps(const DepthImage& image,
                      const KnownSurface& known,
                      const std::vector<KnownPart>& parts);

}  // namespace rangepose
