// What the kernels of the image stages share: a thread for each pixel, access to images.
#pragma once

#include <cuda_runtime.h>

#include "cuda/image_view.h"
#include "stages/scene_channels.h"

namespace rangepose::cuda {

inline constexpr unsigned kPixelColumns = 32;
inline constexpr unsigned kPixelRows = 8;

struct PixelGrid {
  dim3 blocks;
  dim3 threads;
};

inline PixelGrid pixelGrid(int width, int height) {
  const auto parts = [](int pixels, unsigned each) {
    return (static_cast<unsigned>(pixels) + each - 1) / each;
  };
  return {dim3(parts(width, kPixelColumns), parts(height, kPixelRows)),
          dim3(kPixelColumns, kPixelRows)};
}

struct Pixel {
  int x, y;
};

__device__ inline Pixel ownPixel() {
  return {static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x),
          static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
}

/// Reads an image of floats. Coordinates inside of it.
struct FloatReader {
  cudaTextureObject_t texture;
  __device__ float operator()(int x, int y) const {
    return tex2D<float>(texture, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  }
};

__device__ inline FloatReader reader(const ImageView& image) { return {image.texture}; }

__device__ inline void writeFloat(const ImageView& image, int x, int y, float value) {
  surf2Dwrite(value, image.surface, x * static_cast<int>(sizeof(float)), y);
}

__device__ inline EdtTexel readTexel(const ImageView& image, int x, int y) {
  const float4 t =
      tex2D<float4>(image.texture, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  return {t.x, t.y, t.z, t.w};
}

__device__ inline void writeTexel(const ImageView& image, int x, int y, const EdtTexel& t) {
  surf2Dwrite(make_float4(t.site_x, t.site_y, t.signed_sq, t.found),
              image.surface,
              x * static_cast<int>(sizeof(float4)),
              y);
}

}  // namespace rangepose::cuda
