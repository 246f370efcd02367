// A two-dimensional image in a CUDA array, as kernels are given it.
#pragma once

#include <cuda_runtime_api.h>

namespace rangepose::cuda {

/// Owns nothing: an Array, or a GL texture while it is mapped, must outlive it. The function that
/// takes a view says what its elements are: float, float4 or int.
///
/// The texture is read at whole coordinates (tex2D(texture, x + 0.5f, y + 0.5f)): unnormalised,
/// nearest, and clamped to the border. The surface is read and written (surf2Dwrite(value, surface,
/// x * sizeof(element), y)); what it wrote, a texture sees from the next kernel on.
struct ImageView {
  cudaTextureObject_t texture = 0;
  cudaSurfaceObject_t surface = 0;
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
};

}  // namespace rangepose::cuda
