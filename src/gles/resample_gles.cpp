#include <algorithm>
#include <cmath>

#include "gles/channels_gles.h"
#include "stages/resample_core.h"
#include "stages/resample_host.h"

namespace rangepose::gles {
namespace {

/// The pixels that are read, with those left out set to "no measurement".
Image<float> measured(const DepthImage& image,
                      const Image<std::uint8_t>& keep,
                      const PixelBox& box) {
  Image<float> depth(box.width(), box.height(), 0.0f);
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const bool kept = keep.empty() || keep.at(box.x0 + x, box.y0 + y) != 0;
      if (kept) depth.at(x, y) = image.depth_mm.at(box.x0 + x, box.y0 + y);
    }
  }
  return depth;
}

/// Pixels along a side of the largest footprint in the image.
int largestFootprint(const Image<float>& depth_mm, const ResampleSetup& setup) {
  const float farthest = *std::max_element(depth_mm.begin(), depth_mm.end());
  const float reach = setup.parallel != 0.0f ? 1.0f : farthest;
  const float width = std::ceil(setup.footprint_per_mm * reach);
  return static_cast<int>(std::clamp(width, 1.0f, static_cast<float>(kMaxFootprint)));
}

void setUp(Pass& pass, const ResampleSetup& s) {
  pass.set("u_ray", glm::vec4(s.inv_fx, s.inv_fy, s.cx, s.cy))
      .set("u_parallel", s.parallel)
      .set("u_row_x", glm::vec3(s.rotation[0], s.rotation[1], s.rotation[2]))
      .set("u_row_y", glm::vec3(s.rotation[3], s.rotation[4], s.rotation[5]))
      .set("u_row_z", glm::vec3(s.rotation[6], s.rotation[7], s.rotation[8]))
      .set("u_translation", glm::vec3(s.translation[0], s.translation[1], s.translation[2]))
      .set("u_footprint_per_mm", s.footprint_per_mm);
}

}  // namespace

Canvas resample(Device& device,
                const DepthImage& image,
                const Image<std::uint8_t>& keep,
                const OrthoCamera& camera,
                const PixelBox& region) {
  const PixelBox box =
      region.empty() ? PixelBox{0, 0, image.depth_mm.width(), image.depth_mm.height()} : region;
  Canvas result(Format::kR32f, camera.width, camera.height);
  const Texture depth_buffer(Format::kDepth32f, camera.width, camera.height);
  const Framebuffer target(result.texture, &depth_buffer);
  target.clear(glm::vec4(0.0f));
  target.clearDepth();
  if (box.empty()) return result;
  const Image<float> depth = measured(image, keep, box);
  const ResampleSetup setup = resampleSetup(image.camera, camera);
  const int footprint = largestFootprint(depth, setup);
  const Texture depth_texture(depth);
  Pass pass(device, ProgramId::kResample, target);
  setUp(pass, setup);
  pass.texture("u_depth_mm", depth_texture)
      .set("u_first", glm::ivec2(box.x0, box.y0))
      .set("u_footprint", footprint)
      .set("u_target_size", glm::ivec2(camera.width, camera.height))
      .depthTest()
      .drawPoints(box.width() * box.height(), footprint * footprint);
  return result;
}

}  // namespace rangepose::gles
