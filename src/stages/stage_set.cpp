#include "stages/stage_set.h"

#include "core/parallel.h"

namespace rangepose {
namespace {

/// Some ten microseconds of work a piece, at least.
constexpr int kAlignmentsPerPiece = 1;
constexpr int kVerdictsPerPiece = 64;

class HostDepth : public ResidentDepth {
 public:
  HostDepth(const DepthImage& image, const Image<float>& without_background)
      : depth(image), foreground_mm(without_background) {}
  const DepthImage& depth;
  const Image<float>& foreground_mm;
};

/// `result[i] = make(tasks[i])` on all cores.
template <typename Result, typename Task, typename Make>
std::vector<Result> forEachTask(const std::vector<Task>& tasks, int grain, const Make& make) {
  std::vector<Result> results(tasks.size());
  parallelFor(static_cast<int>(tasks.size()), grain, [&](int begin, int end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      results[i] = make(tasks[i]);
    }
  });
  return results;
}

}  // namespace

std::unique_ptr<ResidentDepth> StageSet::uploadDepth(const DepthImage& depth,
                                                     const Image<float>& foreground_mm) {
  return std::make_unique<HostDepth>(depth, foreground_mm);
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

}  // namespace rangepose
