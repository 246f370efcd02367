// What kernels use of CUDA C++, when they are compiled for the host (see cuda/emulated/README.md).
#pragma once

#include <atomic>
#include <cmath>

#include "cuda_runtime_api.h"

#define __global__
#define __device__
#define __launch_bounds__(...)
#define __grid_constant__
/// A block runs on one thread of the host, so what is the host thread's own is the block's.
#define __shared__ static thread_local

struct dim3 {
  unsigned x, y, z;
  constexpr dim3(unsigned columns = 1, unsigned rows = 1, unsigned layers = 1)
      : x(columns), y(rows), z(layers) {}
};

struct float4 {
  float x, y, z, w;
};
inline float4 make_float4(float x, float y, float z, float w) { return {x, y, z, w}; }

inline constinit thread_local dim3 threadIdx{0, 0, 0};
inline constinit thread_local dim3 blockIdx{0, 0, 0};
inline constinit thread_local dim3 blockDim{1, 1, 1};
inline constinit thread_local dim3 gridDim{1, 1, 1};

void __syncthreads();
int __syncthreads_count(int predicate);

template <typename T>
T __ldg(const T* address) {
  return *address;
}
template <typename T>
T __ldcg(const T* address) {
  return std::atomic_ref<T>(*const_cast<T*>(address)).load(std::memory_order_relaxed);
}
template <typename T, typename Value>
T atomicAdd(T* address, Value value) {
  return std::atomic_ref<T>(*address).fetch_add(static_cast<T>(value));
}
template <typename T>
T atomicMin(T* address, T value) {
  std::atomic_ref<T> cell(*address);
  T old = cell.load();
  while (value < old && !cell.compare_exchange_weak(old, value)) {
  }
  return old;
}
template <typename T>
T atomicMax(T* address, T value) {
  std::atomic_ref<T> cell(*address);
  T old = cell.load();
  while (old < value && !cell.compare_exchange_weak(old, value)) {
  }
  return old;
}

namespace rangepose::cuda::emulated {

/// One number: a float, or an int32.
enum class TexelKind { kFloat, kFloat4, kInt };
template <typename T>
inline constexpr TexelKind kKindOf = TexelKind::kInt;
template <>
inline constexpr TexelKind kKindOf<float> = TexelKind::kFloat;
template <>
inline constexpr TexelKind kKindOf<float4> = TexelKind::kFloat4;

/// Where the texel lies, clamped to the image. Ends the launch with an error for a texture that
/// does not exist (any more), or whose array has another format.
const void* texelAt(cudaTextureObject_t texture, int x, int y, TexelKind kind);
/// Likewise for a surface; outside of it is an error.
void* texelOf(cudaSurfaceObject_t surface, int x_bytes, int y, TexelKind kind);

}  // namespace rangepose::cuda::emulated

template <typename T>
T tex2D(cudaTextureObject_t texture, float x, float y) {
  using namespace rangepose::cuda::emulated;
  return *static_cast<const T*>(texelAt(
      texture, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), kKindOf<T>));
}
template <typename T>
void surf2Dwrite(T value, cudaSurfaceObject_t surface, int x_bytes, int y) {
  using namespace rangepose::cuda::emulated;
  *static_cast<T*>(texelOf(surface, x_bytes, y, kKindOf<T>)) = value;
}
