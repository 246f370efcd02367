#include "core/error.h"
#include "cuda/channels.h"
#include "cuda/check.h"
#include "cuda/image_body.h"
#include "cuda/launch.h"
#include "cuda/pixels.h"

namespace rangepose::cuda {
namespace {

__global__ void splatKernel(const __grid_constant__ DepthPixels depth,
                            const __grid_constant__ ResampleSetup setup,
                            PixelBox region,
                            int width,
                            int height,
                            unsigned int* nearest) {
  const auto [x, y] = ownPixel();
  const int u = region.x0 + x;
  const int v = region.y0 + y;
  if (u >= region.x1 || v >= region.y1) return;
  const int index = v * depth.width + u;
  if (depth.keep != nullptr && depth.keep[index] == 0) return;
  splatPixel(setup, u, v, depth.depth_mm[index], width, height, [&](int at, unsigned int bits) {
    atomicMin(nearest + at, bits);
  });
}

__global__ void splatsDoneKernel(const unsigned int* nearest, ImageView range) {
  const auto [x, y] = ownPixel();
  if (x >= range.width || y >= range.height) return;
  writeFloat(range, x, y, rangeOfSplats(nearest[y * range.width + x]));
}

}  // namespace

void resample(const DepthPixels& depth,
              const ResampleSetup& setup,
              const PixelBox& region,
              unsigned int* scratch,
              ImageView range_px,
              cudaStream_t stream) {
  RP_CHECK(region.x0 >= 0 && region.y0 >= 0 && region.x1 <= depth.width &&
               region.y1 <= depth.height && range_px.width > 0 && range_px.height > 0,
           "the region must lie in the depth image, and the result must not be empty");
  static_assert(kNoSplat == 0xffffffffU, "memset below writes bytes");
  const std::size_t bytes = sizeof(unsigned int) * static_cast<std::size_t>(range_px.width) *
                            static_cast<std::size_t>(range_px.height);
  RP_CUDA(cudaMemsetAsync(scratch, 0xff, bytes, stream));
  if (!region.empty()) {
    const PixelGrid read = pixelGrid(region.width(), region.height());
    launch(splatKernel,
           read.blocks,
           read.threads,
           stream,
           depth,
           setup,
           region,
           range_px.width,
           range_px.height,
           scratch);
    RP_LAUNCHED("splats");
  }
  const PixelGrid grid = pixelGrid(range_px.width, range_px.height);
  launch(splatsDoneKernel, grid.blocks, grid.threads, stream, scratch, range_px);
  RP_LAUNCHED("range of splats");
}

}  // namespace rangepose::cuda
