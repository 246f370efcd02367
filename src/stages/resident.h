// Images where a path keeps them: in host memory, as GL textures, on a CUDA device.
#pragma once

#include <memory>

#include "core/error.h"
#include "stages/foreground.h"
#include "stages/scene_channels.h"

namespace rangepose {

/// Scene channels.
class ResidentScene {
 public:
  virtual ~ResidentScene() = default;
  virtual const OrthoCamera& camera() const = 0;
  /// A copy in host memory.
  virtual SceneChannels download() const = 0;
};

/// A depth image, and what of it is not background.
class ResidentDepth {
 public:
  virtual ~ResidentDepth() = default;
};

/// A foreground, with its depth image and mask also where the path keeps them: `resident` may refer
/// to `on_host`, so it stays where it is.
struct ResidentForeground {
  ResidentForeground() = default;
  ResidentForeground(const ResidentForeground&) = delete;
  ResidentForeground& operator=(const ResidentForeground&) = delete;

  Foreground on_host;
  std::unique_ptr<ResidentDepth> resident;
};

/// The path's own kind of an image that it is given; throws Error where another path made it.
template <typename Own, typename Resident>
const Own& ownImage(const Resident& resident) {
  const auto* own = dynamic_cast<const Own*>(&resident);
  RP_CHECK(own != nullptr, "the image is of another path");
  return *own;
}

}  // namespace rangepose
