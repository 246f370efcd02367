#include "stages/resample_host.h"

#include <algorithm>
#include <vector>

#include "stages/resample_core.h"

namespace rangepose {

ResampleSetup resampleSetup(const Camera& sensor, const OrthoCamera& camera) {
  const Pose ortho_from_camera = camera.camera_from_ortho.inverse();
  ResampleSetup setup{};
  const bool flat = sensor.orthographic;
  setup.inv_fx = static_cast<float>(flat ? sensor.pixel_size_mm : 1.0 / sensor.fx);
  setup.inv_fy = static_cast<float>(flat ? sensor.pixel_size_mm : 1.0 / sensor.fy);
  setup.cx = static_cast<float>(sensor.cx);
  setup.cy = static_cast<float>(sensor.cy);
  setup.parallel = flat ? 1.0f : 0.0f;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      setup.rotation[row * 3 + column] =
          static_cast<float>(ortho_from_camera.rotation[column][row] / camera.pixel_mm);
    }
  }
  const glm::dvec3 shift = ortho_from_camera.translation_mm / camera.pixel_mm;
  setup.translation[0] = static_cast<float>(shift.x + 0.5 * camera.width - 0.5);
  setup.translation[1] = static_cast<float>(shift.y + 0.5 * camera.height - 0.5);
  setup.translation[2] = static_cast<float>(shift.z);
  setup.footprint_per_mm = static_cast<float>(sensor.pixelSpacingMm(1.0) / camera.pixel_mm);
  return setup;
}

namespace host {

Image<float> resample(const DepthImage& image,
                      const Image<std::uint8_t>& keep,
                      const OrthoCamera& camera,
                      const PixelBox& region) {
  const ResampleSetup setup = resampleSetup(image.camera, camera);
  const PixelBox box =
      region.empty() ? PixelBox{0, 0, image.depth_mm.width(), image.depth_mm.height()} : region;
  Image<float> range(camera.width, camera.height, 0.0f);
  for (int v = box.y0; v < box.y1; ++v) {
    const float* depth = image.depth_mm.row(v);
    const std::uint8_t* kept = keep.empty() ? nullptr : keep.row(v);
    for (int u = box.x0; u < box.x1; ++u) {
      if (depth[u] == 0.0f || (kept != nullptr && kept[u] == 0)) continue;
      const Splat splat = splatOf(setup, u, v, depth[u]);
      if (splat.range <= 0.0f) continue;
      const int y1 = std::min(splat.y + splat.count, camera.height);
      const int x1 = std::min(splat.x + splat.count, camera.width);
      for (int y = std::max(splat.y, 0); y < y1; ++y) {
        for (int x = std::max(splat.x, 0); x < x1; ++x) {
          float& nearest = range.at(x, y);
          if (nearest == 0.0f || splat.range < nearest) nearest = splat.range;
        }
      }
    }
  }
  return range;
}

}  // namespace host
}  // namespace rangepose
