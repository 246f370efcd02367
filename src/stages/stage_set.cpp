#include "stages/stage_set.h"

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

class HostDepth : public ResidentDepth {
 public:
  HostDepth(const DepthImage& image, const Image<std::uint8_t>& kept)
      : depth(image), keep(kept), foreground_mm(masked(image, kept)) {}
  const DepthImage& depth;
  const Image<std::uint8_t>& keep;
  const Image<float> foreground_mm;
};

/// Tasks of a piece where each renders or is a stage: all, one after the other, where the path
/// belongs to one thread.
int renderGrain(const StageSet& stages, std::size_t tasks) {
  return stages.concurrent() ? 1 : std::max(static_cast<int>(tasks), 1);
}

/// `result[i] = make(tasks[i])` on all cores.
template <typename Result, typename Task, typename Make>
std::vector<Result> forEachTask(const std::vector<Task>& tasks, int grain, const Make& make) {
  std::vector<Result> results(tasks.size());
  parallelForEach(tasks.size(), grain, [&](std::size_t i) { results[i] = make(tasks[i]); });
  return results;
}

}  // namespace

std::unique_ptr<ResidentDepth> StageSet::uploadDepth(const DepthImage& depth,
                                                     const Image<std::uint8_t>& keep) {
  return std::make_unique<HostDepth>(depth, keep);
}

std::unique_ptr<ResidentForeground> StageSet::foreground(const DepthImage& measured,
                                                         const ForegroundTask& task) {
  auto found = std::make_unique<ResidentForeground>();
  found->on_host = host::foreground(measured, task);
  found->resident = uploadDepth(found->on_host.depth, found->on_host.mask);
  return found;
}

LateralExtent StageSet::extent(const ResidentDepth& depth) {
  const auto& own = static_cast<const HostDepth&>(depth);
  return host::extentOf(own.depth, own.keep);
}

std::unique_ptr<ResidentScene> StageSet::prepare(const ResidentDepth& depth,
                                                 const OrthoCamera& camera,
                                                 const PixelBox& region,
                                                 const ChannelOptions& options) {
  const auto& own = static_cast<const HostDepth&>(depth);
  return prepare(own.depth, own.keep, camera, region, options);
}

std::vector<std::unique_ptr<ResidentScene>> StageSet::prepareEach(
    const ResidentDepth& depth,
    const std::vector<WindowTask>& windows,
    const ChannelOptions& options) {
  return forEachTask<std::unique_ptr<ResidentScene>>(
      windows, renderGrain(*this, windows.size()), [&](const WindowTask& window) {
        return prepare(depth, window.camera, window.region, options);
      });
}

std::vector<IcpResult> StageSet::align(const ResidentDepth& depth,
                                       const std::vector<AlignTask>& tasks) {
  const auto& own = static_cast<const HostDepth&>(depth);
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

std::vector<CheckResult> StageSet::judge(const ResidentDepth& depth,
                                         const std::vector<JudgeTask>& tasks) {
  const auto& own = static_cast<const HostDepth&>(depth);
  return forEachTask<CheckResult>(tasks, kVerdictsPerPiece, [&](const JudgeTask& task) {
    return host::checkPoints(
        *task.points, task.camera_from_object, task.visible_mm2, own.depth, task.options);
  });
}

std::vector<IcpResult> StageSet::alignSurfaces(const ResidentDepth& depth,
                                               const std::vector<RenderTask>& tasks) {
  const auto& own = static_cast<const HostDepth&>(depth);
  for (const RenderTask& task : tasks) {
    RP_CHECK(task.max_points >= 1, "a surface is aligned by one point at least");
  }
  const auto render = [&](const RenderTask& task) {
    const Camera& camera = own.depth.camera;
    const Image<SurfaceTexel> surface =
        renderSurface(*task.mesh, camera, task.camera_from_object, task.window);
    std::vector<SurfacePoint> points =
        pointsOfSurface(surface, camera, task.window, task.camera_from_object, task.max_points);
    if (task.alignment.rim_reach_mm > 0.0) {
      const std::vector<SurfacePoint> rim =
          rimOfSurface(surface, camera, task.window, task.camera_from_object, task.max_points);
      points.insert(points.end(), rim.begin(), rim.end());
    }
    return points;
  };
  const auto points =
      forEachTask<std::vector<SurfacePoint>>(tasks, renderGrain(*this, tasks.size()), render);
  std::vector<AlignTask> alignments;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const RenderTask& task = tasks[i];
    alignments.push_back(
        {&points[i], task.camera_from_object, task.center_mm, task.radius_mm, task.alignment});
  }
  return align(depth, alignments);
}

std::vector<CheckResult> StageSet::judgeSurfaces(const ResidentDepth& depth,
                                                 const std::vector<RenderTask>& tasks) {
  const auto& own = static_cast<const HostDepth&>(depth);
  return forEachTask<CheckResult>(
      tasks, renderGrain(*this, tasks.size()), [&](const RenderTask& task) {
        const Image<SurfaceTexel> surface =
            renderSurface(*task.mesh, own.depth.camera, task.camera_from_object, task.window);
        return host::check(surface, task.window, own.depth, task.sphere(), task.check);
      });
}

const ViewPoints& StageSet::pointsOfViews(const ReferenceObject& object,
                                          int max_points,
                                          std::vector<int> views) {
  constexpr int kViewsPerPiece = 16;
  ViewPoints& points = points_of_views_[{object.serial, max_points}];
  points.resize(object.views.size());
  const auto of = [&](int view) -> std::vector<SurfacePoint>& {
    return points[static_cast<std::size_t>(view)];
  };
  std::erase_if(views, [&](int view) { return !of(view).empty(); });
  std::sort(views.begin(), views.end());
  views.erase(std::unique(views.begin(), views.end()), views.end());
  parallelFor(static_cast<int>(views.size()), kViewsPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int view = views[static_cast<std::size_t>(i)];
      of(view) = pointsAndRimOfView(object, view, max_points);
    }
  });
  return points;
}

}  // namespace rangepose
