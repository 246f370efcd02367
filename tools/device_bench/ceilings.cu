// What the GPU does at best: a large copy, and multiply-adds that depend on nothing but registers.
#include <algorithm>
#include <vector>

#include "cuda/buffer.h"
#include "cuda/check.h"
#include "cuda/stream.h"
#include "device_bench/rows.h"

namespace rangepose::device_bench {
namespace {

constexpr int kChains = 8;    // of each thread, so that one does not wait for the other
constexpr int kSteps = 4096;  // of each chain
constexpr unsigned kBlocks = 4096;
constexpr unsigned kThreads = 256;

__global__ void multiplyAdd(float factor, float* result) {
  float value[kChains];
#pragma unroll
  for (int i = 0; i < kChains; ++i) value[i] = static_cast<float>(threadIdx.x + i);
  for (int step = 0; step < kSteps; ++step) {
#pragma unroll
    for (int i = 0; i < kChains; ++i) value[i] = __fmaf_rn(value[i], factor, 1.0f);
  }
  float sum = 0.0f;
#pragma unroll
  for (int i = 0; i < kChains; ++i) sum += value[i];
  // Never true, but the compiler does not know.
  if (sum == -1.0f) *result = sum;
}

/// The fastest of some runs [ms].
template <typename Work>
double fastestMs(cudaStream_t stream, const Work& work) {
  constexpr int kRuns = 10;
  cuda::Event begin;
  cuda::Event end;
  double fastest = 1.0e9;
  for (int i = 0; i < kRuns; ++i) {
    begin.record(stream);
    work();
    end.record(stream);
    fastest = std::min(fastest, static_cast<double>(elapsedMs(begin, end)));
  }
  return fastest;
}

}  // namespace

Ceilings measureCeilings() {
  const cuda::Stream stream;
  constexpr std::size_t kBytes = std::size_t{1} << 29;
  const cuda::Buffer<char> from(kBytes);
  const cuda::Buffer<char> to(kBytes);
  RP_CUDA(cudaMemsetAsync(from.data(), 1, kBytes, stream.get()));
  const double copy_ms = fastestMs(stream.get(), [&] {
    RP_CUDA(
        cudaMemcpyAsync(to.data(), from.data(), kBytes, cudaMemcpyDeviceToDevice, stream.get()));
  });
  const cuda::Buffer<float> result(1);
  const double add_ms = fastestMs(stream.get(), [&] {
    multiplyAdd<<<kBlocks, kThreads, 0, stream.get()>>>(0.999f, result.data());
    RP_LAUNCHED("multiply-add");
  });
  Ceilings ceilings;
  ceilings.bytes_per_s = 2.0 * static_cast<double>(kBytes) / (copy_ms / 1000.0);
  ceilings.operations_per_s =
      2.0 * kChains * kSteps * static_cast<double>(kBlocks) * kThreads / (add_ms / 1000.0);
  return ceilings;
}

}  // namespace rangepose::device_bench
