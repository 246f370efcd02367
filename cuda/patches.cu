#include "cuda/channels.h"
#include "cuda/check.h"
#include "cuda/launch.h"
#include "cuda/patches_body.h"
#include "cuda/pixels.h"

namespace rangepose::cuda {
namespace {

/// Reads past the first-level cache, which does not see what other multiprocessors have joined.
struct CurrentLabel {
  const std::int32_t* labels;
  __device__ int operator()(int index) const { return __ldcg(labels + index); }
};

__global__ void firstLabelsKernel(ImageView range, ImageView edges, std::int32_t* labels) {
  const auto [x, y] = ownPixel();
  if (x >= range.width || y >= range.height) return;
  labels[y * range.width + x] = firstLabel(x, y, range.width, [&](int u, int v) {
    return reader(range)(u, v) != 0.0f && reader(edges)(u, v) == 0.0f;
  });
}

__global__ void joinKernel(int width, int height, std::int32_t* labels) {
  const auto [x, y] = ownPixel();
  if (x >= width || y >= height) return;
  joinNeighbours(x, y, width, CurrentLabel{labels}, [&](int index, int value) {
    return atomicMin(labels + index, value);
  });
}

/// Writing roots while others follow labels to them is harmless: both lead to the same root.
__global__ void rootsKernel(int width, int height, std::int32_t* labels) {
  const auto [x, y] = ownPixel();
  if (x >= width || y >= height) return;
  const int index = y * width + x;
  const CurrentLabel label{labels};
  if (label(index) != kNoPatch) labels[index] = rootOf(index, label);
}

}  // namespace

void patches(ImageView range_px, ImageView edges, std::int32_t* labels, cudaStream_t stream) {
  if (range_px.width == 0 || range_px.height == 0) return;
  const PixelGrid grid = pixelGrid(range_px.width, range_px.height);
  launch(firstLabelsKernel, grid.blocks, grid.threads, stream, range_px, edges, labels);
  RP_LAUNCHED("first labels");
  launch(joinKernel, grid.blocks, grid.threads, stream, range_px.width, range_px.height, labels);
  RP_LAUNCHED("joined patches");
  launch(rootsKernel, grid.blocks, grid.threads, stream, range_px.width, range_px.height, labels);
  RP_LAUNCHED("roots of patches");
}

}  // namespace rangepose::cuda
