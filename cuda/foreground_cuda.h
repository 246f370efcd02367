// The foreground of depth images, found on the device, with its memory kept from image to image.
#pragma once

#include <memory>
#include <vector>

#include "cuda/foreground.h"
#include "cuda/scene_cuda.h"
#include "stages/plane_draws.h"

namespace rangepose::cuda {

class ForegroundFinder : public ForegroundStage {
 public:
  /// `workspace` must outlive it. So many rounds of planes are launched before the host asks
  /// whether there may be more: a floor, four walls, and faces of sheets that hide them.
  explicit ForegroundFinder(Workspace& workspace, int rounds_at_once = 8)
      : workspace_(workspace), rounds_at_once_(rounds_at_once) {}

  std::unique_ptr<ResidentDepth> upload(const DepthImage& depth,
                                        const Image<std::uint8_t>& keep) override;
  /// The host waits once, for mask, planes and noise; once more where lost pixels were filled, and
  /// for each further batch of rounds.
  std::unique_ptr<ResidentForeground> find(const DepthImage& measured,
                                           const ForegroundTask& task) override;
  LateralExtent extent(const ResidentDepth& depth) override;

 private:
  /// All but the draws; waits for the device where it must grow.
  ForegroundMemory memoryFor(const Camera& camera, const DepthBuffers& buffers);
  void drawFor(int rounds, cudaStream_t stream);

  Workspace& workspace_;
  int rounds_at_once_;
  Buffer<float> measured_;
  Buffer<std::uint32_t> bins_;
  Buffer<double> parts_;
  Buffer<double> samples_[2];
  Buffer<ForegroundState> state_;
  Buffer<unsigned long long> extent_;
  PlaneDraws random_;
  std::vector<std::uint64_t> drawn_;
  Buffer<std::uint64_t> draws_;
};

}  // namespace rangepose::cuda
