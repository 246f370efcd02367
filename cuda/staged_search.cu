#include "core/error.h"
#include "cuda/check.h"
#include "cuda/launch.h"
#include "cuda/pixels.h"
#include "cuda/staged_body.h"
#include "cuda/staged_search.h"

namespace rangepose::cuda {
namespace {

constexpr unsigned kThreads = 128;
constexpr unsigned kTilePixels = 16;  ///< a block of the image programs is that wide and high
constexpr int kStepsPerCheck = 8;

unsigned blocksFor(int count) { return (static_cast<unsigned>(count) + kThreads - 1) / kThreads; }

/// Blocks over the pixels of a tile, for every view.
dim3 tileBlocks(int pitch, int views) {
  const unsigned side = (static_cast<unsigned>(pitch) + kTilePixels - 1) / kTilePixels;
  return {side, side, static_cast<unsigned>(views)};
}

__device__ int ownIndex() { return static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x); }

__device__ bool isDone(const SimplexState& state) {
  return state.phase == static_cast<int>(SimplexPhase::kDone);
}

__global__ void startKernel(const __grid_constant__ SearchSetup setup,
                            const ViewEntry* views,
                            float seed_range_px,
                            SimplexState* states) {
  const int view = ownIndex();
  if (view < setup.views) states[view] = stagedStart(setup, views[view], seed_range_px);
}

__global__ void errorKernel(const __grid_constant__ SearchSetup setup,
                            ImageView atlas,
                            ImageView range,
                            ImageView distance,
                            float outside_distance,
                            const SimplexState* states,
                            ErrorTerms* terms) {
  const auto [u, v] = ownPixel();
  const int view = static_cast<int>(blockIdx.z);
  if (u >= setup.size || v >= setup.size || isDone(states[view])) return;
  const int columns = atlas.width / setup.size;
  const float4 t = tex2D<float4>(atlas.texture,
                                 static_cast<float>(view % columns * setup.size + u) + 0.5f,
                                 static_cast<float>(view / columns * setup.size + v) + 0.5f);
  terms[(view * setup.size + v) * setup.size + u] = stagedPixel(setup,
                                                                outside_distance,
                                                                ReferenceTexel(t.x, t.y, t.z, t.w),
                                                                u,
                                                                v,
                                                                states[view].candidate,
                                                                reader(range),
                                                                reader(distance));
}

__global__ void reduceKernel(
    int size, int level, const SimplexState* states, const ErrorTerms* from, ErrorTerms* into) {
  const auto [x, y] = ownPixel();
  const int view = static_cast<int>(blockIdx.z);
  const int pitch = levelPitch(size, level);
  const int previous = levelPitch(size, level - 1);
  if (x >= pitch || y >= pitch || isDone(states[view])) return;
  into[(view * pitch + y) * pitch + x] = reducePixel(
      x, y, previous, [&](int px, int py) { return from[(view * previous + py) * previous + px]; });
}

__global__ void stepKernel(const __grid_constant__ SearchSetup setup,
                           const ViewEntry* views,
                           const ErrorTerms* terms,
                           SimplexState* states,
                           int* running) {
  const int view = ownIndex();
  if (view >= setup.views || isDone(states[view])) return;
  if (stagedStep(setup, views[view], terms[view], states[view])) atomicAdd(running, 1);
}

__global__ void answerKernel(const SimplexState* states,
                             int views,
                             int window,
                             Hypothesis* answers) {
  const int view = ownIndex();
  if (view >= views) return;
  const SimplexState& state = states[view];
  const SimplexPoint& best = state.vertex[state.lowest];
  answers[view] = {view, window, {best.x, best.y, best.z}, best.value, state.iterations};
}

__global__ void replayKernel(
    SimplexState* states, const float* values, int count, float spread, int max_iterations) {
  const int index = ownIndex();
  if (index < count) simplexAdvance(states[index], values[index], spread, max_iterations);
}

}  // namespace

StagedSearch::StagedSearch(int views, int size)
    : views_(views),
      size_(size),
      states_(static_cast<std::size_t>(views)),
      running_(1),
      running_here_(1) {
  RP_CHECK(views >= 1 && views <= 65535 && size >= 1, "1..65535 views can be searched in stages");
  for (int level = 0; level <= lastLevel(size); ++level) {
    const auto pitch = static_cast<std::size_t>(levelPitch(size, level));
    levels_.emplace_back(static_cast<std::size_t>(views) * pitch * pitch);
  }
}

void StagedSearch::check(const StagedInput& in) const {
  RP_CHECK(in.setup.views == views_ && in.setup.size == size_ && in.object.views() == views_ &&
               in.atlas.width % size_ == 0,
           "the search was made for another object");
  RP_CHECK(in.range_px.width == in.setup.frame.width && in.range_px.height == in.range_px.width,
           "the search was set up for windows of another size");
}

void StagedSearch::start(const StagedInput& in, float seed_range_px, cudaStream_t stream) {
  check(in);
  launch(startKernel,
         blocksFor(views_),
         kThreads,
         stream,
         in.setup,
         in.object.entries(),
         seed_range_px,
         states_.data());
  RP_LAUNCHED("start of the simplexes");
}

void StagedSearch::evaluate(const StagedInput& in, cudaStream_t stream) {
  check(in);
  const dim3 threads(kTilePixels, kTilePixels);
  launch(errorKernel,
         tileBlocks(size_, views_),
         threads,
         stream,
         in.setup,
         in.atlas,
         in.range_px,
         in.distance_px,
         in.object.outsideDistance(),
         states_.data(),
         levels_[0].data());
  RP_LAUNCHED("errors of pixels");
  for (int level = 1; level < static_cast<int>(levels_.size()); ++level) {
    const auto at = static_cast<std::size_t>(level);
    launch(reduceKernel,
           tileBlocks(levelPitch(size_, level), views_),
           threads,
           stream,
           size_,
           level,
           states_.data(),
           levels_[at - 1].data(),
           levels_[at].data());
    RP_LAUNCHED("reduction");
  }
}

void StagedSearch::step(const StagedInput& in, cudaStream_t stream) {
  RP_CUDA(cudaMemsetAsync(running_.data(), 0, sizeof(int), stream));
  launch(stepKernel,
         blocksFor(views_),
         kThreads,
         stream,
         in.setup,
         in.object.entries(),
         terms(),
         states_.data(),
         running_.data());
  RP_LAUNCHED("simplex step");
}

void StagedSearch::answer(int window, Hypothesis* answers, cudaStream_t stream) const {
  launch(
      answerKernel, blocksFor(views_), kThreads, stream, states_.data(), views_, window, answers);
  RP_LAUNCHED("answers of the simplexes");
}

void StagedSearch::search(const StagedInput& in,
                          float seed_range_px,
                          int window,
                          Hypothesis* answers,
                          cudaStream_t stream) {
  start(in, seed_range_px, stream);
  // A simplex asks at most 4 + 5 * max_iterations times, so this ends.
  for (int steps = 1;; ++steps) {
    evaluate(in, stream);
    step(in, stream);
    if (steps % kStepsPerCheck != 0) continue;
    running_.download(running_here_.data(), 1, stream);
    RP_CUDA(cudaStreamSynchronize(stream));
    if (*running_here_.data() == 0) break;
  }
  answer(window, answers, stream);
}

void simplexSteps(SimplexState* states,
                  const float* values,
                  int count,
                  const SimplexOptions& options,
                  cudaStream_t stream) {
  if (count == 0) return;
  launch(replayKernel,
         blocksFor(count),
         kThreads,
         stream,
         states,
         values,
         count,
         options.spread,
         options.max_iterations);
  RP_LAUNCHED("simplex steps");
}

}  // namespace rangepose::cuda
