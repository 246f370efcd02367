// Shared memory for a type whose constructor must not run for each thread.
#pragma once

namespace rangepose::cuda {

template <typename T>
struct Storage {
  alignas(T) unsigned char bytes[sizeof(T)];
  __device__ T& get() { return *reinterpret_cast<T*>(bytes); }
};

}  // namespace rangepose::cuda
