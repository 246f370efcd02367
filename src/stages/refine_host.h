// Foreground and refinement on the host: whole for the host path, as what is left to it for others.
#pragma once

#include <memory>
#include <vector>

#include "stages/stage_set.h"

namespace rangepose {

/// A depth image in host memory.
class HostDepth : public ResidentDepth {
 public:
  /// Both must outlive it.
  HostDepth(const DepthImage& image, const Image<std::uint8_t>& kept);

  const DepthImage& depth;
  const Image<std::uint8_t>& keep;
  const Image<float> foreground_mm;  ///< 0 where it is not kept
};

class ForegroundOnHost : public ForegroundStage {
 public:
  std::unique_ptr<ResidentDepth> upload(const DepthImage& depth,
                                        const Image<std::uint8_t>& keep) override;
  /// Uploads what it finds.
  std::unique_ptr<ResidentForeground> find(const DepthImage& measured,
                                           const ForegroundTask& task) override;
  LateralExtent extent(const ResidentDepth& depth) override;
};

class RefineOnHost : public RefineStage {
 public:
  /// `drawing` renders surfaces, and must outlive it; by several threads at a time if `threads`.
  RefineOnHost(StageProbe& drawing, bool threads) : drawing_(drawing), threads_(threads) {}

  std::vector<IcpResult> align(const ResidentDepth& depth,
                               const std::vector<AlignTask>& tasks) override;
  std::vector<CheckResult> judge(const ResidentDepth& depth,
                                 const std::vector<JudgeTask>& tasks) override;
  std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                       const std::vector<RenderTask>& tasks) override;
  std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                         const std::vector<RenderTask>& tasks) override;

 private:
  int renderGrain(std::size_t tasks) const;

  StageProbe& drawing_;
  bool threads_;
};

}  // namespace rangepose
