#include <utility>

#include "core/error.h"
#include "cuda/channels.h"
#include "cuda/check.h"
#include "cuda/edt_body.h"
#include "cuda/image_body.h"
#include "cuda/launch.h"
#include "cuda/pixels.h"

namespace rangepose::cuda {
namespace {

constexpr int kEdtThreads = 256;

__global__ void medianKernel(ImageView range, ImageView result) {
  const auto [x, y] = ownPixel();
  if (x >= range.width || y >= range.height) return;
  writeFloat(result, x, y, medianPixel(x, y, range.width, range.height, reader(range)));
}

__global__ void edgesKernel(ImageView range, float threshold_px, ImageView result) {
  const auto [x, y] = ownPixel();
  if (x >= range.width || y >= range.height) return;
  writeFloat(result, x, y, edgePixel(x, y, range.width, range.height, reader(range), threshold_px));
}

__global__ void edtInitKernel(ImageView range, ImageView edges, int passes, ImageView into) {
  const auto [x, y] = ownPixel();
  if (x >= range.width || y >= range.height) return;
  writeTexel(into, x, y, edtInit(x, y, reader(range)(x, y), reader(edges)(x, y), passes));
}

__global__ void edtStepKernel(ImageView from, ImageView into) {
  const auto [x, y] = ownPixel();
  if (x >= from.width || y >= from.height) return;
  const EdtTexel texel = edtStep(x, y, [&](int u, int v) {
    const bool inside = u >= 0 && v >= 0 && u < from.width && v < from.height;
    return inside ? readTexel(from, u, v) : EdtTexel{0.0f, 0.0f, 0.0f, 0.0f};
  });
  writeTexel(into, x, y, texel);
}

__global__ void edtRootKernel(ImageView texels, ImageView result) {
  const auto [x, y] = ownPixel();
  if (x >= texels.width || y >= texels.height) return;
  writeFloat(result, x, y, edtRoot(readTexel(texels, x, y)));
}

__global__ __launch_bounds__(kEdtThreads) void edtTileKernel(ImageView range,
                                                             ImageView edges,
                                                             int passes,
                                                             ImageView result) {
  __shared__ EdtShared shared;
  const EdtTileSetup tile = {static_cast<int>(blockIdx.x) * kEdtTile,
                             static_cast<int>(blockIdx.y) * kEdtTile,
                             range.width,
                             range.height,
                             passes};
  DeviceBlock<kEdtThreads> block;
  edtTile(
      block, shared, tile, reader(range), reader(edges), [&](int x, int y, const EdtTexel& texel) {
        writeFloat(result, x, y, edtRoot(texel));
      });
}

void checkSize(const ImageView& a, const ImageView& b) {
  RP_CHECK(a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0,
           "images must not be empty and of the same size");
}

}  // namespace

void median(ImageView range, ImageView result, cudaStream_t stream) {
  checkSize(range, result);
  const PixelGrid grid = pixelGrid(range.width, range.height);
  launch(medianKernel, grid.blocks, grid.threads, stream, range, result);
  RP_LAUNCHED("median");
}

void edges(ImageView range_px, float threshold_px, ImageView result, cudaStream_t stream) {
  checkSize(range_px, result);
  const PixelGrid grid = pixelGrid(range_px.width, range_px.height);
  launch(edgesKernel, grid.blocks, grid.threads, stream, range_px, threshold_px, result);
  RP_LAUNCHED("edges");
}

ImageView distanceTexels(ImageView range_px,
                         ImageView edges,
                         int passes,
                         const EdtScratch& scratch,
                         cudaStream_t stream) {
  checkSize(range_px, edges);
  checkSize(range_px, scratch.even);
  checkSize(range_px, scratch.odd);
  const PixelGrid grid = pixelGrid(range_px.width, range_px.height);
  ImageView current = scratch.even;
  ImageView next = scratch.odd;
  launch(edtInitKernel, grid.blocks, grid.threads, stream, range_px, edges, passes, current);
  RP_LAUNCHED("start of the distance transform");
  for (int pass = 0; pass < passes; ++pass) {
    launch(edtStepKernel, grid.blocks, grid.threads, stream, current, next);
    RP_LAUNCHED("pass of the distance transform");
    std::swap(current, next);
  }
  return current;
}

void distance(ImageView range_px,
              ImageView edges,
              int passes,
              const EdtScratch& scratch,
              ImageView result,
              cudaStream_t stream) {
  checkSize(range_px, edges);
  checkSize(range_px, result);
  const int longest = range_px.width > range_px.height ? range_px.width : range_px.height;
  if (passes <= kEdtTilePasses && longest <= kEdtTileImage) {
    const auto tiles = [](int pixels) {
      return static_cast<unsigned>((pixels + kEdtTile - 1) / kEdtTile);
    };
    const dim3 blocks(tiles(range_px.width), tiles(range_px.height));
    launch(edtTileKernel, blocks, kEdtThreads, stream, range_px, edges, passes, result);
    RP_LAUNCHED("distance transform");
    return;
  }
  const ImageView texels = distanceTexels(range_px, edges, passes, scratch, stream);
  const PixelGrid grid = pixelGrid(range_px.width, range_px.height);
  launch(edtRootKernel, grid.blocks, grid.threads, stream, texels, result);
  RP_LAUNCHED("end of the distance transform");
}

}  // namespace rangepose::cuda
