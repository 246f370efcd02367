// Alignment and judgement of many poses, with their buffers kept on the device from call to call.
#pragma once

#include <vector>

#include "cuda/point_places.h"
#include "cuda/refine.h"
#include "cuda/scene_cuda.h"
#include "cuda/surface_painter.h"
#include "cuda/surface_points.h"

namespace rangepose::cuda {

class Refiner : public RefineStage {
 public:
  /// `context` draws surfaces; null: the host does. Both must outlive it.
  Refiner(Workspace& workspace, gles::Context* context)
      : workspace_(workspace), painter_(workspace, context) {}

  std::vector<IcpResult> align(const ResidentDepth& depth,
                               const std::vector<AlignTask>& tasks) override;
  std::vector<CheckResult> judge(const ResidentDepth& depth,
                                 const std::vector<JudgeTask>& tasks) override;
  std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                       const std::vector<RenderTask>& tasks) override;
  std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                         const std::vector<RenderTask>& tasks) override;
  std::int64_t draws() const { return painter_.draws(); }

 private:
  /// Puts the points of all tasks into points_; first[i] is where those of task i begin.
  template <typename Task>
  std::vector<int> uploadPoints(const std::vector<Task>& tasks, cudaStream_t stream);

  Workspace& workspace_;
  SurfacePainter painter_;
  PointPlaces places_;
  Buffer<SurfacePoint> points_;
  std::size_t kept_ = 0;         ///< of the kept points those that are in points_
  Buffer<SurfacePoint> picked_;  ///< of rendered surfaces
  Buffer<IcpTask> icp_tasks_;
  Buffer<IcpResult> icp_results_;
  Buffer<PointsTask> points_tasks_;
  Buffer<PickTask> picks_;
  Buffer<SurfaceTask> surface_tasks_;
  Buffer<CheckResult> verdicts_;
};

}  // namespace rangepose::cuda
