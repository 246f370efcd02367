#include "stages/refine_host.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "stages/foreground_host.h"

namespace rangepose {
namespace {

/// Some ten microseconds of work a piece, at least.
constexpr int kAlignmentsPerPiece = 1;
constexpr int kVerdictsPerPiece = 64;

Image<float> masked(const DepthImage& depth, const Image<std::uint8_t>& keep) {
  if (keep.empty()) return depth.depth_mm;
  Image<float> result(keep.width(), keep.height(), 0.0f);
  std::transform(keep.begin(),
                 keep.end(),
                 depth.depth_mm.begin(),
                 result.begin(),
                 [](std::uint8_t kept, float mm) { return kept != 0 ? mm : 0.0f; });
  return result;
}

/// `result[i] = make(tasks[i])` on all cores.
template <typename Result, typename Task, typename Make>
std::vector<Result> forEachTask(const std::vector<Task>& tasks, int grain, const Make& make) {
  std::vector<Result> results(tasks.size());
  parallelForEach(tasks.size(), grain, [&](std::size_t i) { results[i] = make(tasks[i]); });
  return results;
}

std::vector<SurfacePoint> pointsFor(const RenderTask& task,
                                    const Image<SurfaceTexel>& surface,
                                    const Camera& camera) {
  std::vector<SurfacePoint> points =
      pointsOfSurface(surface, camera, task.window, task.camera_from_object, task.max_points);
  if (task.alignment.rim_reach_mm > 0.0) {
    const std::vector<SurfacePoint> rim =
        rimOfSurface(surface, camera, task.window, task.camera_from_object, task.max_points);
    points.insert(points.end(), rim.begin(), rim.end());
  }
  return points;
}

}  // namespace

HostDepth::HostDepth(const DepthImage& image, const Image<std::uint8_t>& kept)
    : depth(image), keep(kept), foreground_mm(masked(image, kept)) {}

std::unique_ptr<ResidentDepth> ForegroundOnHost::upload(const DepthImage& depth,
                                                        const Image<std::uint8_t>& keep) {
  return std::make_unique<HostDepth>(depth, keep);
}

std::unique_ptr<ResidentForeground> ForegroundOnHost::find(const DepthImage& measured,
                                                           const ForegroundTask& task) {
  auto found = std::make_unique<ResidentForeground>();
  found->on_host = host::foreground(measured, task);
  found->resident = upload(found->on_host.depth, found->on_host.mask);
  return found;
}

LateralExtent ForegroundOnHost::extent(const ResidentDepth& depth) {
  const auto& own = ownImage<HostDepth>(depth);
  return host::extentOf(own.depth, own.keep);
}

/// Tasks of a piece where each renders: all, one after the other, where that is for one thread.
int RefineOnHost::renderGrain(std::size_t tasks) const {
  return threads_ ? 1 : std::max(static_cast<int>(tasks), 1);
}

std::vector<IcpResult> RefineOnHost::align(const ResidentDepth& depth,
                                           const std::vector<AlignTask>& tasks) {
  const auto& own = ownImage<HostDepth>(depth);
  return forEachTask<IcpResult>(tasks, kAlignmentsPerPiece, [&](const AlignTask& task) {
    return host::icp(*task.points,
                     own.depth.camera,
                     own.foreground_mm,
                     task.start,
                     task.center_mm,
                     task.radius_mm,
                     task.options);
  });
}

std::vector<CheckResult> RefineOnHost::judge(const ResidentDepth& depth,
                                             const std::vector<JudgeTask>& tasks) {
  const auto& own = ownImage<HostDepth>(depth);
  return forEachTask<CheckResult>(tasks, kVerdictsPerPiece, [&](const JudgeTask& task) {
    return host::checkPoints(
        *task.points, task.camera_from_object, task.visible_mm2, own.depth, task.options);
  });
}

std::vector<IcpResult> RefineOnHost::alignSurfaces(const ResidentDepth& depth,
                                                   const std::vector<RenderTask>& tasks) {
  const Camera& camera = ownImage<HostDepth>(depth).depth.camera;
  for (const RenderTask& task : tasks) {
    RP_CHECK(task.max_points >= 1, "a surface is aligned by one point at least");
  }
  const auto points = forEachTask<std::vector<SurfacePoint>>(
      tasks, renderGrain(tasks.size()), [&](const RenderTask& task) {
        const Image<SurfaceTexel> surface =
            drawing_.renderSurface(*task.mesh, camera, task.camera_from_object, task.window);
        return pointsFor(task, surface, camera);
      });
  std::vector<AlignTask> alignments;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const RenderTask& task = tasks[i];
    alignments.push_back(
        {&points[i], task.camera_from_object, task.center_mm, task.radius_mm, task.alignment});
  }
  return align(depth, alignments);
}

std::vector<CheckResult> RefineOnHost::judgeSurfaces(const ResidentDepth& depth,
                                                     const std::vector<RenderTask>& tasks) {
  const DepthImage& image = ownImage<HostDepth>(depth).depth;
  return forEachTask<CheckResult>(tasks, renderGrain(tasks.size()), [&](const RenderTask& task) {
    const Image<SurfaceTexel> surface =
        drawing_.renderSurface(*task.mesh, image.camera, task.camera_from_object, task.window);
    return host::check(surface, task.window, image, task.sphere(), task.check);
  });
}

}  // namespace rangepose
