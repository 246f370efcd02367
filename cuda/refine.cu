#include "cuda/check.h"
#include "cuda/launch.h"
#include "cuda/refine.h"
#include "cuda/storage.h"

namespace rangepose::cuda {
namespace {

constexpr int kFewThreads = 64;    ///< for the first rounds: many poses with few points
constexpr int kManyThreads = 256;  ///< for the last rounds: few poses with many points
constexpr int kSurfaceThreads = 256;

// One block a multiprocessor may be enough (the second number of the launch bounds): otherwise the
// sums of 30 doubles a thread are spilled on some architectures.

/// Reads a depth image in memory.
struct DepthAt {
  const float* depth_mm;
  int width;
  __device__ float operator()(bool where, int u, int v) const {
    return where ? __ldg(depth_mm + v * width + u) : 0.0f;
  }
};

template <int kThreads>
__global__ __launch_bounds__(kThreads,
                             1) void alignKernel(const __grid_constant__ ResidentImage scene,
                                                 const IcpTask* __restrict__ tasks,
                                                 const SurfacePoint* __restrict__ points,
                                                 IcpResult* __restrict__ results) {
  __shared__ Storage<IcpShared> shared;
  const DepthAt read{scene.depth_mm, scene.camera.width};
  DeviceBlock<kThreads> block;
  alignPose(
      block, shared.get(), tasks[blockIdx.x], scene.camera, read, points, results[blockIdx.x]);
}

__global__ __launch_bounds__(kFewThreads,
                             1) void judgePointsKernel(const __grid_constant__ ResidentImage depth,
                                                       const PointsTask* __restrict__ tasks,
                                                       const SurfacePoint* __restrict__ points,
                                                       CheckResult* __restrict__ results) {
  DeviceBlock<kFewThreads> block;
  judgeTaskPoints(block,
                  tasks[blockIdx.x],
                  depth.camera,
                  DepthAt{depth.depth_mm, depth.camera.width},
                  points,
                  results[blockIdx.x]);
}

__global__ __launch_bounds__(kSurfaceThreads, 1) void judgeSurfacesKernel(
    const __grid_constant__ ResidentImage depth,
    const SurfaceTask* __restrict__ tasks,
    CheckResult* __restrict__ results) {
  const SurfaceTask& task = tasks[blockIdx.x];
  const auto surface = [&](int x, int y) {
    const float4 t = tex2D<float4>(task.surface.texture,
                                   static_cast<float>(task.column + x) + 0.5f,
                                   static_cast<float>(task.row + y) + 0.5f);
    return SurfaceTexel(t.x, t.y, t.z, t.w);
  };
  DeviceBlock<kSurfaceThreads> block;
  judgeRendered(block,
                surface,
                task.window,
                task.sphere,
                task.options,
                depth.camera,
                DepthAt{depth.depth_mm, depth.camera.width},
                results[blockIdx.x]);
}

}  // namespace

void align(const ResidentImage& scene,
           const IcpTask* tasks,
           int task_count,
           int most_points,
           const SurfacePoint* points,
           IcpResult* results,
           cudaStream_t stream) {
  if (task_count == 0) return;
  const unsigned blocks = static_cast<unsigned>(task_count);
  if (most_points <= kFewThreads) {
    launch(alignKernel<kFewThreads>, blocks, kFewThreads, stream, scene, tasks, points, results);
  } else {
    launch(alignKernel<kManyThreads>, blocks, kManyThreads, stream, scene, tasks, points, results);
  }
  RP_LAUNCHED("alignment");
}

void judgePoints(const ResidentImage& depth,
                 const PointsTask* tasks,
                 int task_count,
                 const SurfacePoint* points,
                 CheckResult* results,
                 cudaStream_t stream) {
  if (task_count == 0) return;
  launch(judgePointsKernel,
         static_cast<unsigned>(task_count),
         kFewThreads,
         stream,
         depth,
         tasks,
         points,
         results);
  RP_LAUNCHED("verdict on points");
}

void judgeSurfaces(const ResidentImage& depth,
                   const SurfaceTask* tasks,
                   int task_count,
                   CheckResult* results,
                   cudaStream_t stream) {
  if (task_count == 0) return;
  launch(judgeSurfacesKernel,
         static_cast<unsigned>(task_count),
         kSurfaceThreads,
         stream,
         depth,
         tasks,
         results);
  RP_LAUNCHED("verdict on surfaces");
}

}  // namespace rangepose::cuda
