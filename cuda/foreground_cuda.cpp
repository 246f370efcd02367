#include "cuda/foreground_cuda.h"

#include <utility>

#include "core/error.h"
#include "cuda/check.h"
#include "cuda/extent_body.h"
#include "stages/dropouts_core.h"

namespace rangepose::cuda {
ForegroundMemory ForegroundFinder::memoryFor(const Camera& camera, const DepthBuffers& buffers) {
  const int samples = mostSamples(camera.width, camera.height);
  measured_.reserve(buffers.depth.size());
  bins_.reserve(kNoiseBins);
  parts_.reserve(kImageParts);
  state_.reserve(1);
  ForegroundMemory memory;
  for (int side = 0; side < 2; ++side) {
    samples_[side].reserve(6 * static_cast<std::size_t>(samples));
    memory.samples[side] = {samples_[side].data(), samples};
  }
  memory.measured = measured_.data();
  memory.depth = buffers.depth.data();
  memory.foreground = buffers.foreground.data();
  memory.keep = buffers.keep.data();
  memory.bins = bins_.data();
  memory.parts = parts_.data();
  memory.state = state_.data();
  return memory;
}

void ForegroundFinder::drawFor(int rounds, cudaStream_t stream) {
  const std::size_t wanted =
      static_cast<std::size_t>(rounds) * static_cast<std::size_t>(kDrawsOfRound);
  if (draws_.size() >= wanted) return;
  while (drawn_.size() < wanted) drawn_.push_back(random_.next());
  draws_.reserve(wanted);
  draws_.upload(drawn_.data(), wanted, stream);
}

std::unique_ptr<ResidentForeground> ForegroundFinder::find(const DepthImage& measured,
                                                           const ForegroundTask& task) {
  const Camera& camera = measured.camera;
  const std::size_t pixels = measured.depth_mm.size();
  RP_CHECK(measured.depth_mm.width() == camera.width && measured.depth_mm.height() == camera.height,
           "depth image: another size than its camera's");
  RP_CHECK(task.options.max_planes <= kMostPlanes, "more background planes than there is room for");
  const cudaStream_t stream = workspace_.begin();
  const std::shared_ptr<DepthBuffers> buffers = workspace_.takeDepth(pixels);
  ForegroundMemory memory = memoryFor(camera, *buffers);
  const ForegroundRules rules = rulesFor(camera, task);
  measured_.upload(measured.depth_mm.data(), pixels, stream);
  RP_CUDA(cudaMemsetAsync(memory.state, 0, sizeof *memory.state, stream));
  RP_CUDA(cudaMemsetAsync(memory.bins, 0, kNoiseBins * sizeof *memory.bins, stream));
  depthNoise(memory, camera, stream);
  fillDropouts(memory, camera, stream);
  takeSamples(memory, rules, stream);
  auto found = std::make_unique<ResidentForeground>();
  Foreground& on_host = found->on_host;
  on_host.mask = Image<std::uint8_t>(camera.width, camera.height);
  ForegroundState state;
  const Landing landing(stream);
  for (int round = 0; state.done == 0; round += rounds_at_once_) {
    drawFor(round + rounds_at_once_, stream);
    memory.draws = draws_.data();
    findPlanes(memory, rules, round, rounds_at_once_, stream);
    maskForeground(memory, rules, stream);
    buffers->keep.download(on_host.mask.data(), pixels, stream);
    state_.download(&state, 1, stream);
    workspace_.synchronize();
  }
  on_host.noise_mm = state.noise.noise_mm;
  on_host.background.assign(state.plane, state.plane + state.planes);
  on_host.depth = measured;
  if (areMany(state.lost, state.measured)) {
    buffers->depth.download(on_host.depth.depth_mm.data(), pixels, stream);
    workspace_.synchronize();
  }
  found->resident = std::make_unique<CudaDepth>(camera, buffers);
  return found;
}

std::unique_ptr<ResidentDepth> ForegroundFinder::upload(const DepthImage& depth,
                                                        const Image<std::uint8_t>& keep) {
  return std::make_unique<CudaDepth>(depth, keep, workspace_);
}

LateralExtent ForegroundFinder::extent(const ResidentDepth& image) {
  const auto& depth = ownImage<CudaDepth>(image);
  const cudaStream_t stream = workspace_.begin();
  extent_.reserve(4);
  extentOf(depth.foreground(), depth.camera(), extent_.data(), stream);
  const std::vector<unsigned long long> keys = extent_.download(4, stream);
  LateralExtent extent;
  extent.low = {valueOfKey(keys[0]), valueOfKey(keys[1])};
  extent.high = {-valueOfKey(keys[2]), -valueOfKey(keys[3])};
  return extent;
}

}  // namespace rangepose::cuda
