// What found parts hide of another pose. A pose just behind nearer data is doubtful: the surface
// there seems to be another one. It is not where a found part lies between the two.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/pose.h"
#include "geometry/mesh.h"
#include "pipeline/explained_pixels.h"
#include "stages/check_core.h"
#include "stages/surface.h"

namespace rangepose {

/// Depth [mm] at which the ray of each of `pixels` first leaves the part, 0 where no face of the
/// mesh looks away from the camera.
std::vector<float> exitDepths(const Mesh& mesh,
                              const Pose& camera_from_object,
                              const Camera& camera,
                              const SurfaceWindow& window,
                              const std::vector<std::int32_t>& pixels);

/// Parts that were found: which of them each pixel shows, and where they end behind it.
class FoundParts {
 public:
  /// `pixels`: of the image.
  explicit FoundParts(std::size_t pixels) : part_(pixels, kNone), exit_mm_(pixels, 0.0f) {}

  /// The pixels that a part explains, and exitDepths() of these. Of two parts at a pixel the first
  /// stays.
  void add(const std::vector<std::int32_t>& pixels, const std::vector<float>& exit_mm);
  /// Share of the buried pixels of a pose that lie under found parts: not in front of where these
  /// end, but for `slack_mm`. A part that shows much of what the pose itself explains is a rival,
  /// or the pose itself, and hides nothing.
  double coveredShare(const std::vector<std::int32_t>& explained,
                      const std::vector<BuriedPixel>& buried,
                      double slack_mm) const;

 private:
  static constexpr std::int32_t kNone = -1;

  std::vector<std::int32_t> part_;
  std::vector<float> exit_mm_;
  std::int32_t count_ = 0;
};

/// The check of a pose of which found parts hide `share` of what is buried.
CheckResult withCovered(CheckResult check, double share);

}  // namespace rangepose
