// Refinement of many poses at once: alignment with the depth image, and the verdict on each (paper
// Sect. 7). Contracts in src/stages/icp_host.h and check_host.h. All pointers are on the device.
// Nothing waits, nothing is allocated.
#pragma once

#include <cuda_runtime_api.h>

#include "cuda/icp_body.h"
#include "cuda/image_view.h"
#include "cuda/verdict_body.h"

namespace rangepose::cuda {

/// A depth image on the device: camera.width * camera.height numbers, row by row, 0 = nothing
/// there.
struct ResidentImage {
  Camera camera;
  const float* depth_mm = nullptr;
};

/// One result a task. `scene` is the depth image without background; `most_points` is the largest
/// number of points of a task.
void align(const ResidentImage& scene,
           const IcpTask* tasks,
           int task_count,
           int most_points,
           const SurfacePoint* points,
           IcpResult* results,
           cudaStream_t stream);

/// One result a task: points of posed objects against the whole depth image.
void judgePoints(const ResidentImage& depth,
                 const PointsTask* tasks,
                 int task_count,
                 const SurfacePoint* points,
                 CheckResult* results,
                 cudaStream_t stream);

/// A rendered surface (float4, as SurfaceTexel) to be judged.
struct SurfaceTask {
  ImageView surface;  ///< window.width x window.height from (column, row) on
  SurfaceWindow window;
  Sphere sphere;  ///< around the object, in the camera frame
  CheckOptions options;
  int column = 0;  ///< of the window's first pixel in the image [px]
  int row = 0;     ///< [px]
};

/// One result a task: rendered surfaces, with their outlines, against the whole depth image.
void judgeSurfaces(const ResidentImage& depth,
                   const SurfaceTask* tasks,
                   int task_count,
                   CheckResult* results,
                   cudaStream_t stream);

}  // namespace rangepose::cuda
