// A block of threads as a policy, so that the body of a kernel runs on the device and, thread after
// thread, in a test on the host.
//
// A body is a template over the block and is written in phases:
//
//   block.forEachThread([&](int thread) { ... });  // what one thread does between two barriers
//   block.barrier();                               // before a phase reads what others wrote
//   block.leader([&] { ... });                     // one thread alone, no barrier
//   block.sum<float>(values, [&](const V& sum) { ... });
//
// A thread's own values live from phase to phase in a PerThread<T>: registers on the device, an
// array on the host. Everything else that a body changes is either shared memory (by leader, or
// where each thread has its own element) or the same in all threads.
//
// `sum` adds up structures made of one type of number, member by member, and gives the result to
// the leader. The order is fixed and the same on both sides: in each warp of 32 pairs at distance
// 16, 8, 4, 2, 1, then the warps one after the other. Barriers are before and after the leader's
// turn.
#pragma once

#include <type_traits>

#ifdef __CUDACC__
#define RP_BODY __device__ inline
#else
#define RP_BODY inline
#endif

#include "core/host_device.h"

namespace rangepose::cuda {

inline constexpr int kWarp = 32;

namespace block_detail {

template <typename Number, typename Value>
inline constexpr int kNumbers = static_cast<int>(sizeof(Value) / sizeof(Number));

/// Member k of a structure of numbers.
template <typename Number, typename Value>
RP_HD Number& number(Value& value, int k) {
  static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % sizeof(Number) == 0);
  return reinterpret_cast<Number*>(&value)[k];
}

}  // namespace block_detail

#ifdef __CUDACC__

template <int kThreadCount>
class DeviceBlock {
  static_assert(kThreadCount % kWarp == 0);

 public:
  static constexpr int kThreads = kThreadCount;

  template <typename T>
  class PerThread {
   public:
    __device__ T& operator[](int) { return value_; }

   private:
    T value_{};
  };

  template <typename Body>
  __device__ void forEachThread(const Body& body) {
    body(static_cast<int>(threadIdx.x));
  }
  template <typename Body>
  __device__ void leader(const Body& body) {
    if (threadIdx.x == 0) body();
  }
  __device__ void barrier() { __syncthreads(); }

  template <typename Number, typename Value, typename Body>
  __device__ void sum(PerThread<Value>& values, const Body& body) {
    using namespace block_detail;
    constexpr int kCount = kNumbers<Number, Value>;
    constexpr int kWarps = kThreads / kWarp;
    __shared__ Number partial[kCount][kWarps];
    Value& own = values[static_cast<int>(threadIdx.x)];
#pragma unroll
    for (int k = 0; k < kCount; ++k) {
      Number n = number<Number>(own, k);
#pragma unroll
      for (int step = kWarp / 2; step > 0; step /= 2) n += __shfl_xor_sync(0xffffffffU, n, step);
      if (threadIdx.x % kWarp == 0) partial[k][threadIdx.x / kWarp] = n;
    }
    __syncthreads();
    if (threadIdx.x == 0) {
      Value total;
#pragma unroll
      for (int k = 0; k < kCount; ++k) {
        Number n = partial[k][0];
#pragma unroll
        for (int warp = 1; warp < kWarps; ++warp) n += partial[k][warp];
        number<Number>(total, k) = n;
      }
      body(total);
    }
    __syncthreads();
  }

  /// The smallest value of all threads, to the leader; barriers as in `sum`.
  template <typename T, typename Body>
  __device__ void smallest(PerThread<T>& values, const Body& body) {
    constexpr int kWarps = kThreads / kWarp;
    __shared__ T partial[kWarps];
    T least = values[static_cast<int>(threadIdx.x)];
#pragma unroll
    for (int step = kWarp / 2; step > 0; step /= 2) {
      const T other = __shfl_xor_sync(0xffffffffU, least, step);
      if (other < least) least = other;
    }
    if (threadIdx.x % kWarp == 0) partial[threadIdx.x / kWarp] = least;
    __syncthreads();
    if (threadIdx.x == 0) {
      for (int warp = 1; warp < kWarps; ++warp) {
        if (partial[warp] < least) least = partial[warp];
      }
      body(least);
    }
    __syncthreads();
  }
};

#else

template <int kThreadCount>
class HostBlock {
  static_assert(kThreadCount % kWarp == 0);

 public:
  static constexpr int kThreads = kThreadCount;

  template <typename T>
  class PerThread {
   public:
    T& operator[](int thread) { return values_[thread]; }

   private:
    T values_[kThreadCount]{};
  };

  template <typename Body>
  void forEachThread(const Body& body) {
    for (int thread = 0; thread < kThreads; ++thread) body(thread);
  }
  template <typename Body>
  void leader(const Body& body) {
    body();
  }
  void barrier() {}

  template <typename Number, typename Value, typename Body>
  void sum(PerThread<Value>& values, const Body& body) {
    using namespace block_detail;
    Value total{};
    for (int k = 0; k < kNumbers<Number, Value>; ++k) {
      Number all{};
      for (int first = 0; first < kThreads; first += kWarp) {
        Number n[kWarp];
        for (int lane = 0; lane < kWarp; ++lane) n[lane] = number<Number>(values[first + lane], k);
        for (int step = kWarp / 2; step > 0; step /= 2) {
          for (int lane = 0; lane < step; ++lane) n[lane] += n[lane + step];
        }
        all = first == 0 ? n[0] : all + n[0];
      }
      number<Number>(total, k) = all;
    }
    body(total);
  }

  /// The smallest value of all threads, to the leader; barriers as in `sum`.
  template <typename T, typename Body>
  void smallest(PerThread<T>& values, const Body& body) {
    T least = values[0];
    for (int thread = 1; thread < kThreads; ++thread) {
      if (values[thread] < least) least = values[thread];
    }
    body(least);
  }
};

#endif

}  // namespace rangepose::cuda

#ifdef RP_CUDA_EMULATED
#include "cuda/emulated/device_block.h"
#endif
