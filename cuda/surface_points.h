// The points of rendered surfaces, for their alignment. Nothing waits, nothing is allocated.
#pragma once

#include <cuda_runtime_api.h>

#include "cuda/icp_body.h"
#include "cuda/image_view.h"
#include "stages/surface.h"

namespace rangepose::cuda {

/// A part of an image of rendered surfaces (float4, as SurfaceTexel).
struct PickTask {
  ImageView surface;
  int column = 0;  ///< of the window's first pixel in the image [px]
  int row = 0;     ///< [px]
  SurfaceWindow window;
  int max_points = 0;  ///< as in pointsOfSurface
};

/// For each task (all on the device) the points of its surface, rendered at tasks[i].start, into
/// `points` from tasks[i].first_point on, mostPoints(window) at most, with its rim where the task's
/// alignment uses it; sets tasks[i].point_count.
void pickPoints(const PickTask* picks,
                const Camera& camera,
                int task_count,
                IcpTask* tasks,
                SurfacePoint* points,
                cudaStream_t stream);

}  // namespace rangepose::cuda
