#include <algorithm>
#include <cmath>

#include "gles/channels_gles.h"
#include "stages/resample_core.h"
#include "stages/resample_host.h"

namespace rangepose::gles {
namespace {

/// Pixels along a side of the largest footprint in the image.
int largestFootprint(float farthest_mm, const ResampleSetup& setup) {
  const float reach = setup.parallel != 0.0f ? 1.0f : farthest_mm;
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

float farthest(const Image<float>& depth_mm) {
  return depth_mm.empty() ? 0.0f : *std::max_element(depth_mm.begin(), depth_mm.end());
}

Canvas resample(Device& device,
                const MeasuredTexture& image,
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
  const ResampleSetup setup = resampleSetup(image.camera, camera);
  const int footprint = largestFootprint(image.farthest_mm, setup);
  Pass pass(device, ProgramId::kResample, target);
  setUp(pass, setup);
  pass.texture("u_depth_mm", image.depth_mm)
      .set("u_first", glm::ivec2(box.x0, box.y0))
      .set("u_columns", box.width())
      .set("u_footprint", footprint)
      .set("u_target_size", glm::ivec2(camera.width, camera.height))
      .depthTest()
      .drawPoints(box.width() * box.height(), footprint * footprint);
  return result;
}

}  // namespace rangepose::gles
