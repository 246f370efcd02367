#include "cuda/block.h"
#include "cuda/check.h"
#include "cuda/launch.h"
#include "cuda/surface_points.h"
#include "cuda/surface_points_body.h"

namespace rangepose::cuda {
namespace {

constexpr int kThreads = 256;

__global__ __launch_bounds__(kThreads) void pickPointsKernel(const PickTask* __restrict__ picks,
                                                             const __grid_constant__ Camera camera,
                                                             IcpTask* __restrict__ tasks,
                                                             SurfacePoint* __restrict__ points) {
  __shared__ PickShared<kThreads> shared;
  const PickTask& pick = picks[blockIdx.x];
  IcpTask& task = tasks[blockIdx.x];
  const auto surface = [&](int x, int y) {
    const float4 t = tex2D<float4>(pick.surface.texture,
                                   static_cast<float>(pick.column + x) + 0.5f,
                                   static_cast<float>(pick.row + y) + 0.5f);
    return SurfaceTexel(t.x, t.y, t.z, t.w);
  };
  DeviceBlock<kThreads> block;
  pickPoints(block,
             shared,
             surface,
             pick.window,
             camera,
             task.start,
             pick.max_points,
             task.options.rim_reach_mm > 0.0,
             points + task.first_point,
             task.point_count);
}

}  // namespace

void pickPoints(const PickTask* picks,
                const Camera& camera,
                int task_count,
                IcpTask* tasks,
                SurfacePoint* points,
                cudaStream_t stream) {
  if (task_count == 0) return;
  launch(pickPointsKernel,
         static_cast<unsigned>(task_count),
         kThreads,
         stream,
         picks,
         camera,
         tasks,
         points);
  RP_LAUNCHED("points of surfaces");
}

}  // namespace rangepose::cuda
