// The foreground of depth images, found on the device, with its memory kept from image to image.
#pragma once

#include <memory>
#include <vector>

#include "cuda/foreground.h"
#include "cuda/scene_cuda.h"
#include "stages/plane_draws.h"

namespace rangepose::cuda {

class ForegroundFinder {
 public:
  /// `workspace` must outlive it.
  explicit ForegroundFinder(Workspace& workspace) : workspace_(workspace) {}

  /// Contract of StageSet::foreground. One trip to the host: mask, planes and noise; a second one
  /// where lost pixels were filled, and for each further eight rounds of planes.
  std::unique_ptr<ResidentForeground> find(const DepthImage& measured, const ForegroundTask& task);
  /// Contract of StageSet::extent.
  LateralExtent extent(const CudaDepth& depth);

 private:
  /// All but the draws; waits for the device where it must grow.
  ForegroundMemory memoryFor(const Camera& camera, const DepthBuffers& buffers);
  void drawFor(int rounds, cudaStream_t stream);

  Workspace& workspace_;
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
