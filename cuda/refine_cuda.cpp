#include "cuda/refine_cuda.h"

#include <algorithm>

#include "core/error.h"
#include "cuda/surface_points_body.h"

namespace rangepose::cuda {

template <typename Task>
std::vector<int> Refiner::uploadPoints(const std::vector<Task>& tasks, cudaStream_t stream) {
  std::vector<int> first = places_.place(tasks);
  const std::vector<SurfacePoint>& kept = places_.kept();
  const std::vector<SurfacePoint>& others = places_.others();
  const std::size_t all = kept.size() + others.size();
  if (all >= points_.size()) {
    points_.reserve(2 * all + 1);
    kept_ = 0;
  }
  kept_ = std::min(kept_, places_.unmoved());
  points_.upload(kept.data() + kept_, kept.size() - kept_, stream, kept_);
  kept_ = kept.size();
  points_.upload(others.data(), others.size(), stream, kept_);
  return first;
}

std::vector<IcpResult> Refiner::align(const ResidentDepth& image,
                                      const std::vector<AlignTask>& tasks) {
  if (tasks.empty()) return {};
  const auto& depth = ownImage<CudaDepth>(image);
  const cudaStream_t stream = workspace_.begin();
  const std::vector<int> first = uploadPoints(tasks, stream);
  std::vector<IcpTask> own;
  int most_points = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const AlignTask& task = tasks[i];
    task.options.check();
    const int count = static_cast<int>(task.points->size());
    most_points = std::max(most_points, count);
    own.push_back({first[i],
                   count,
                   task.start,
                   task.center_mm,
                   task.radius_mm,
                   task.options,
                   icpShrink(task.options)});
  }
  icp_tasks_.reserve(own.size());
  icp_tasks_.upload(own.data(), own.size(), stream);
  icp_results_.reserve(own.size());
  cuda::align({depth.camera(), depth.foreground()},
              icp_tasks_.data(),
              static_cast<int>(own.size()),
              most_points,
              points_.data(),
              icp_results_.data(),
              stream);
  return icp_results_.download(own.size(), stream);
}

std::vector<CheckResult> Refiner::judge(const ResidentDepth& image,
                                        const std::vector<JudgeTask>& tasks) {
  if (tasks.empty()) return {};
  const auto& depth = ownImage<CudaDepth>(image);
  const cudaStream_t stream = workspace_.begin();
  const std::vector<int> first = uploadPoints(tasks, stream);
  std::vector<PointsTask> own;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const JudgeTask& task = tasks[i];
    own.push_back({first[i],
                   static_cast<int>(task.points->size()),
                   task.camera_from_object,
                   task.visible_mm2,
                   task.options});
  }
  points_tasks_.reserve(own.size());
  points_tasks_.upload(own.data(), own.size(), stream);
  verdicts_.reserve(own.size());
  judgePoints({depth.camera(), depth.pixels().depth_mm},
              points_tasks_.data(),
              static_cast<int>(own.size()),
              points_.data(),
              verdicts_.data(),
              stream);
  return verdicts_.download(own.size(), stream);
}

std::vector<IcpResult> Refiner::alignSurfaces(const ResidentDepth& image,
                                              const std::vector<RenderTask>& tasks) {
  if (tasks.empty()) return {};
  const auto& depth = ownImage<CudaDepth>(image);
  const TileGrid grid = tileGrid(tasks);
  const DeviceImage& painted = painter_.paint(tasks, depth.camera(), grid);
  const cudaStream_t stream = workspace_.begin();
  const Frame frame({&painted}, stream);
  std::vector<IcpTask> own;
  std::vector<PickTask> picks;
  int first = 0;
  int most_points = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const RenderTask& task = tasks[i];
    task.alignment.check();
    RP_CHECK(task.max_points >= 1, "a surface is aligned by one point at least");
    const PixelBox box = grid.box(i, task.window);
    picks.push_back({frame.view(painted), box.x0, box.y0, task.window, task.max_points});
    own.push_back({first,
                   0,  // known on the device only
                   task.camera_from_object,
                   task.center_mm,
                   task.radius_mm,
                   task.alignment,
                   icpShrink(task.alignment)});
    first += mostPoints(task.window);
    most_points = std::max(most_points, task.max_points);
  }
  picked_.reserve(static_cast<std::size_t>(std::max(first, 1)));
  picks_.reserve(picks.size());
  picks_.upload(picks.data(), picks.size(), stream);
  icp_tasks_.reserve(own.size());
  icp_tasks_.upload(own.data(), own.size(), stream);
  icp_results_.reserve(own.size());
  const int count = static_cast<int>(own.size());
  pickPoints(picks_.data(), depth.camera(), count, icp_tasks_.data(), picked_.data(), stream);
  cuda::align({depth.camera(), depth.foreground()},
              icp_tasks_.data(),
              count,
              most_points,
              picked_.data(),
              icp_results_.data(),
              stream);
  return icp_results_.download(own.size(), stream);
}

std::vector<CheckResult> Refiner::judgeSurfaces(const ResidentDepth& image,
                                                const std::vector<RenderTask>& tasks) {
  if (tasks.empty()) return {};
  const auto& depth = ownImage<CudaDepth>(image);
  const TileGrid grid = tileGrid(tasks);
  const DeviceImage& painted = painter_.paint(tasks, depth.camera(), grid);
  const cudaStream_t stream = workspace_.begin();
  const Frame frame({&painted}, stream);
  std::vector<SurfaceTask> own;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const PixelBox box = grid.box(i, tasks[i].window);
    own.push_back(
        {frame.view(painted), tasks[i].window, tasks[i].sphere(), tasks[i].check, box.x0, box.y0});
  }
  surface_tasks_.reserve(own.size());
  surface_tasks_.upload(own.data(), own.size(), stream);
  verdicts_.reserve(own.size());
  cuda::judgeSurfaces({depth.camera(), depth.pixels().depth_mm},
                      surface_tasks_.data(),
                      static_cast<int>(own.size()),
                      verdicts_.data(),
                      stream);
  return verdicts_.download(own.size(), stream);
}

}  // namespace rangepose::cuda
