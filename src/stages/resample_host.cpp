#include "stages/resample_host.h"

#include <algorithm>
#include <cstring>
#include <limits>

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

namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// Eight pixels of a row.
struct EightPixels {
  Float8 depth_mm;
  Int8 wanted;  ///< measured, and kept

  RP_ALWAYS_INLINE EightPixels(const float* depth, const std::uint8_t* kept)
      : depth_mm(load8(depth)), wanted(depth_mm != 0.0f) {
    if (kept == nullptr) return;
    std::uint8_t keep __attribute__((vector_size(kLanes)));
    std::memcpy(&keep, kept, sizeof keep);
    wanted &= __builtin_convertvector(keep, Int8) != 0;
  }
};

/// The last pixels of a row, fewer than eight.
RP_ALWAYS_INLINE EightPixels lastPixels(const float* depth, const std::uint8_t* kept, int count) {
  float depths[kLanes] = {};
  std::uint8_t keep[kLanes] = {};
  std::copy_n(depth, count, depths);
  if (kept != nullptr) std::copy_n(kept, count, keep);
  return {depths, kept == nullptr ? nullptr : keep};
}

/// Of one pixel: what it covers, however much.
void draw(const SplatOf<float>& splat, Image<float>& range) {
  const int y1 = std::min(splat.y + splat.count, range.height());
  const int x1 = std::min(splat.x + splat.count, range.width());
  for (int y = std::max(splat.y, 0); y < y1; ++y) {
    for (int x = std::max(splat.x, 0); x < x1; ++x)
      range.at(x, y) = std::min(range.at(x, y), splat.range);
  }
}

/// Eight that cover one pixel each. Which of two is nearer is anyone's guess: no branch asks.
RP_ALWAYS_INLINE void drawSmall(const SplatOf<Float8>& splat,
                                const Int8& wanted,
                                Image<float>& range) {
  const int width = range.width();
  const Int8 inside =
      wanted & (splat.x >= 0) & (splat.y >= 0) & (splat.x < width) & (splat.y < range.height());
  const Int8 index = pick(inside, splat.y * width + splat.x, Int8{});
  const Float8 nearest = pick(inside, splat.range, splat8(kNone));
  float* pixels = range.data();
  for (int i = 0; i < kLanes; ++i) pixels[index[i]] = std::min(pixels[index[i]], nearest[i]);
}

RP_SIMD_CLONES void drawRow(const ResampleSetup& setup,
                            const float* depth,
                            const std::uint8_t* kept,
                            const PixelBox& box,
                            int v,
                            Image<float>& range) {
  const Float8 steps = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int u = box.x0; u < box.x1; u += kLanes) {
    const std::uint8_t* keep = kept == nullptr ? nullptr : kept + u;
    const int count = box.x1 - u;
    const EightPixels pixels =
        count < kLanes ? lastPixels(depth + u, keep, count) : EightPixels(depth + u, keep);
    if (!anyOf(pixels.wanted)) continue;
    const SplatOf<Float8> splat = splatOf<Float8>(
        setup, steps + static_cast<float>(u), splat8(static_cast<float>(v)), pixels.depth_mm);
    const Int8 wanted = pixels.wanted & splat.drawn;
    if (!anyOf(wanted & (splat.count > 1))) {
      drawSmall(splat, wanted, range);
      continue;
    }
    for (int i = 0; i < kLanes; ++i) {
      if (wanted[i] != 0)
        draw({true, splat.x[i], splat.y[i], splat.count[i], splat.range[i]}, range);
    }
  }
}

}  // namespace

Image<float> resample(const DepthImage& image,
                      const Image<std::uint8_t>& keep,
                      const OrthoCamera& camera,
                      const PixelBox& region) {
  const ResampleSetup setup = resampleSetup(image.camera, camera);
  const PixelBox box =
      region.empty() ? PixelBox{0, 0, image.depth_mm.width(), image.depth_mm.height()} : region;
  Image<float> range(camera.width, camera.height, kNone);
  for (int v = box.y0; v < box.y1; ++v)
    drawRow(setup, image.depth_mm.row(v), keep.empty() ? nullptr : keep.row(v), box, v, range);
  for (float& pixel : range) pixel = pixel == kNone ? 0.0f : pixel;
  return range;
}

}  // namespace host
}  // namespace rangepose
