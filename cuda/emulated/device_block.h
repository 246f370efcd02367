// A block of threads of the emulated device: see cuda/block.h. All but the sums, which are made of
// warps on a real one, is as there: each thread runs by itself and meets the others at barriers.
#pragma once

#include <cuda_runtime.h>

#include "cuda/block.h"
#include "cuda/emulated/launch.h"

namespace rangepose::cuda {

template <int kThreadCount>
class DeviceBlock {
 public:
  static constexpr int kThreads = kThreadCount;

  DeviceBlock() {
    if (blockDim.x != kThreads || blockDim.y * blockDim.z != 1) {
      emulated::failKernel("a block of another size than it was launched with");
    }
  }

  template <typename T>
  class PerThread {
   public:
    T& operator[](int) { return value_; }

   private:
    T value_{};
  };

  template <typename Body>
  void forEachThread(const Body& body) {
    body(static_cast<int>(threadIdx.x));
  }
  template <typename Body>
  void leader(const Body& body) {
    if (threadIdx.x == 0) body();
  }
  void barrier() { __syncthreads(); }

  template <typename Number, typename Value, typename Body>
  void sum(PerThread<Value>& values, const Body& body) {
    gather<Value>(values, [&](auto& host, auto& all) { host.template sum<Number>(all, body); });
  }
  template <typename T, typename Body>
  void smallest(PerThread<T>& values, const Body& body) {
    gather<T>(values, [&](auto& host, auto& all) { host.smallest(all, body); });
  }

 private:
  using Host = HostBlock<kThreadCount>;

  /// Barriers where the device has them: before the leader reads what all have, and after its turn.
  template <typename Value, typename Reduce>
  void gather(PerThread<Value>& values, const Reduce& reduce) {
    __shared__ typename Host::template PerThread<Value> all;
    const int thread = static_cast<int>(threadIdx.x);
    all[thread] = values[thread];
    __syncthreads();
    if (threadIdx.x == 0) {
      Host host;
      reduce(host, all);
    }
    __syncthreads();
  }
};

}  // namespace rangepose::cuda
