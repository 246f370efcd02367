// The image stages on GLES (paper Sect. 5). Twins: src/stages/channels_host.h, resample_host.h.
#pragma once

#include "core/camera.h"
#include "gles/device.h"
#include "stages/scene_channels.h"

namespace rangepose::gles {

/// A depth image on the device.
struct MeasuredTexture {
  const Camera& camera;
  const Texture& depth_mm;  ///< 0 = no measurement, or not to be read
  float farthest_mm;        ///< of all of it
};
float farthest(const Image<float>& depth_mm);

/// Depth image -> orthographic range image; contract of host::resample.
Canvas resample(Device& device,
                const MeasuredTexture& image,
                const OrthoCamera& camera,
                const PixelBox& region);

Canvas median(Device& device, const Texture& range);
Canvas edges(Device& device, const Texture& range_px, float threshold_px);
/// The texels after `passes` passes of Algorithm 1.
Canvas distanceTexels(Device& device, const Texture& range_px, const Texture& edges, int passes);
/// Their roots [px].
Canvas distance(Device& device, const Texture& range_px, const Texture& edges, int passes);
/// Labels (R32I) of connected pixels, by propagation until nothing changes.
Canvas patches(Device& device, const Texture& range_px, const Texture& edges);

}  // namespace rangepose::gles
