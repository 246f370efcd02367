#include "cuda/check.h"
#include "cuda/extent_body.h"
#include "cuda/foreground.h"
#include "cuda/foreground_body.h"
#include "cuda/launch.h"
#include "cuda/pixels.h"
#include "cuda/storage.h"

namespace rangepose::cuda {
namespace {

constexpr int kPartThreads = 256;
constexpr int kTrialThreads = 64;
constexpr int kRoundThreads = 256;

struct MeasuredAt {
  const float* depth_mm;
  int width;
  __device__ float operator()(int u, int v) const { return __ldg(depth_mm + v * width + u); }
};

/// Also outside of the image: 0.
struct DepthAround {
  const float* depth_mm;
  int width;
  int height;
  __device__ double operator()(int u, int v) const {
    const bool inside = u >= 0 && v >= 0 && u < width && v < height;
    return inside ? static_cast<double>(depth_mm[v * width + u]) : 0.0;
  }
};

__global__ __launch_bounds__(kPartThreads) void countDigitsKernel(const float* measured,
                                                                  int width,
                                                                  int height,
                                                                  int digit,
                                                                  const ForegroundState* state,
                                                                  std::uint32_t* counts) {
  __shared__ std::uint32_t bins[kNoiseBins];
  DeviceBlock<kPartThreads> block;
  countDigits(
      block,
      bins,
      state->noise,
      digit,
      static_cast<int>(blockIdx.x),
      kImageParts,
      width,
      height,
      MeasuredAt{measured, width},
      [&](int bin) { atomicAdd(&bins[bin], 1U); },
      [&](int bin, std::uint32_t count) { atomicAdd(counts + bin, count); });
}

__global__ __launch_bounds__(kPartThreads) void pickDigitKernel(int digit,
                                                                ForegroundState* state,
                                                                std::uint32_t* counts) {
  __shared__ std::uint32_t sums[kPartThreads];
  DeviceBlock<kPartThreads> block;
  pickDigit(block, sums, state->noise, digit, counts);
}

__global__ __launch_bounds__(kPartThreads) void sumLowerKernel(
    const float* measured, int width, int height, const ForegroundState* state, double* parts) {
  DeviceBlock<kPartThreads> block;
  sumLower(block,
           state->noise,
           static_cast<int>(blockIdx.x),
           kImageParts,
           width,
           height,
           MeasuredAt{measured, width},
           parts[blockIdx.x]);
}

__global__ void noiseKernel(ForegroundState* state, const double* parts) {
  state->noise.noise_mm = noiseOfParts(state->noise, parts, kImageParts);
}

__global__ void fillKernel(const float* measured,
                           const __grid_constant__ Camera camera,
                           float* depth,
                           ForegroundState* state) {
  const auto [u, v] = ownPixel();
  const int width = camera.width;
  const int height = camera.height;
  bool seen = false;
  bool lost = false;
  if (u < width && v < height) {
    const MeasuredAt read{measured, width};
    seen = read(u, v) > 0.0f;
    depth[v * width + u] = filledPixel(camera, read, u, v, state->noise.noise_mm, lost);
  }
  const int all_seen = __syncthreads_count(seen ? 1 : 0);
  const int all_lost = __syncthreads_count(lost ? 1 : 0);
  if (threadIdx.x != 0 || threadIdx.y != 0) return;
  if (all_seen > 0) atomicAdd(&state->measured, all_seen);
  if (all_lost > 0) atomicAdd(&state->lost, all_lost);
}

__global__ void unlessManyKernel(
    const float* measured, int width, int height, float* depth, const ForegroundState* state) {
  const auto [u, v] = ownPixel();
  if (u >= width || v >= height || areMany(state->lost, state->measured)) return;
  depth[v * width + u] = measured[v * width + u];
}

__global__ __launch_bounds__(kRoundThreads, 1) void takeSamplesKernel(
    const float* depth,
    const __grid_constant__ ForegroundRules rules,
    SampleArrays into,
    ForegroundState* state) {
  __shared__ int first[kRoundThreads];
  DeviceBlock<kRoundThreads> block;
  const DepthAround read{depth, rules.camera.width, rules.camera.height};
  takeSamples(block, first, rules, read, into, *state);
}

/// Arrays can't be passed by value.
struct BothSamples {
  SampleArrays arrays[2];
};

__global__ __launch_bounds__(kTrialThreads) void tryPlaneKernel(
    const __grid_constant__ ForegroundRules rules,
    const __grid_constant__ BothSamples samples,
    const std::uint64_t* draws,
    ForegroundState* state) {
  __shared__ Storage<TrialShared> shared;
  DeviceBlock<kTrialThreads> block;
  tryPlane(block,
           shared.get(),
           *state,
           rules,
           samples.arrays,
           draws,
           static_cast<int>(blockIdx.x),
           [&](unsigned long long key) { atomicMax(&state->best, key); });
}

__global__ __launch_bounds__(kRoundThreads, 1) void settlePlaneKernel(
    const __grid_constant__ ForegroundRules rules,
    const __grid_constant__ BothSamples samples,
    const std::uint64_t* draws,
    ForegroundState* state) {
  __shared__ Storage<RoundShared<kRoundThreads>> shared;
  DeviceBlock<kRoundThreads> block;
  settlePlane(block, shared.get(), *state, rules, samples.arrays, draws);
}

__global__ void maskKernel(const float* depth,
                           const __grid_constant__ ForegroundRules rules,
                           const ForegroundState* state,
                           float* foreground,
                           std::uint8_t* keep) {
  const auto [u, v] = ownPixel();
  if (u >= rules.camera.width || v >= rules.camera.height) return;
  const int at = v * rules.camera.width + u;
  const float mm = depth[at];
  const bool kept = isForeground(*state, rules, u, v, mm);
  foreground[at] = kept ? mm : 0.0f;
  keep[at] = kept ? 1 : 0;
}

__global__ __launch_bounds__(kPartThreads) void extentKernel(const float* depth_mm,
                                                             const __grid_constant__ Camera camera,
                                                             unsigned long long* keys) {
  DeviceBlock<kPartThreads> block;
  extentOfPart(block,
               camera,
               depth_mm,
               static_cast<int>(blockIdx.x),
               kImageParts,
               [&](int k, unsigned long long key) { atomicMin(keys + k, key); });
}

}  // namespace

void depthNoise(const ForegroundMemory& memory, const Camera& camera, cudaStream_t stream) {
  for (int digit = 0; digit < kNoiseDigits; ++digit) {
    launch(countDigitsKernel,
           kImageParts,
           kPartThreads,
           stream,
           memory.measured,
           camera.width,
           camera.height,
           digit,
           memory.state,
           memory.bins);
    RP_LAUNCHED("digits of second differences");
    launch(pickDigitKernel, 1, kPartThreads, stream, digit, memory.state, memory.bins);
    RP_LAUNCHED("digit of the middle difference");
  }
  launch(sumLowerKernel,
         kImageParts,
         kPartThreads,
         stream,
         memory.measured,
         camera.width,
         camera.height,
         memory.state,
         memory.parts);
  RP_LAUNCHED("lower half of second differences");
  launch(noiseKernel, 1, 1, stream, memory.state, memory.parts);
  RP_LAUNCHED("depth noise");
}

void fillDropouts(const ForegroundMemory& memory, const Camera& camera, cudaStream_t stream) {
  const PixelGrid grid = pixelGrid(camera.width, camera.height);
  launch(fillKernel,
         grid.blocks,
         grid.threads,
         stream,
         memory.measured,
         camera,
         memory.depth,
         memory.state);
  RP_LAUNCHED("lost pixels");
  launch(unlessManyKernel,
         grid.blocks,
         grid.threads,
         stream,
         memory.measured,
         camera.width,
         camera.height,
         memory.depth,
         memory.state);
  RP_LAUNCHED("lost pixels where they are few");
}

void takeSamples(const ForegroundMemory& memory,
                 const ForegroundRules& rules,
                 cudaStream_t stream) {
  launch(takeSamplesKernel,
         1,
         kRoundThreads,
         stream,
         memory.depth,
         rules,
         memory.samples[0],
         memory.state);
  RP_LAUNCHED("samples for planes");
}

void findPlanes(const ForegroundMemory& memory,
                const ForegroundRules& rules,
                int first_round,
                int rounds,
                cudaStream_t stream) {
  const BothSamples samples{{memory.samples[0], memory.samples[1]}};
  for (int round = first_round; round < first_round + rounds; ++round) {
    const std::uint64_t* draws =
        memory.draws + static_cast<std::size_t>(round) * static_cast<std::size_t>(kDrawsOfRound);
    launch(
        tryPlaneKernel, kPlaneTrials, kTrialThreads, stream, rules, samples, draws, memory.state);
    RP_LAUNCHED("trial planes");
    launch(settlePlaneKernel, 1, kRoundThreads, stream, rules, samples, draws, memory.state);
    RP_LAUNCHED("plane of a round");
  }
}

void maskForeground(const ForegroundMemory& memory,
                    const ForegroundRules& rules,
                    cudaStream_t stream) {
  const PixelGrid grid = pixelGrid(rules.camera.width, rules.camera.height);
  launch(maskKernel,
         grid.blocks,
         grid.threads,
         stream,
         memory.depth,
         rules,
         memory.state,
         memory.foreground,
         memory.keep);
  RP_LAUNCHED("mask of the foreground");
}

void extentOf(const float* foreground_mm,
              const Camera& camera,
              unsigned long long* keys,
              cudaStream_t stream) {
  RP_CUDA(cudaMemsetAsync(keys, 0xff, 4 * sizeof *keys, stream));
  launch(extentKernel, kImageParts, kPartThreads, stream, foreground_mm, camera, keys);
  RP_LAUNCHED("extent of the foreground");
}

}  // namespace rangepose::cuda
