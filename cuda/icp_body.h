// Alignment of one pose by one block: all iterations, the sums over the points in a fixed order,
// the 6x6 system solved by the leader (paper Sect. 7). Contract in src/stages/icp_host.h; see
// block.h.
#pragma once

#include "cuda/block.h"
#include "stages/icp_host.h"
#include "stages/icp_points_core.h"

namespace rangepose::cuda {

/// A pose to be aligned. Its points lie one after the other in an array of all points.
struct IcpTask {
  int first_point = 0;
  int point_count = 0;
  Pose start;                 ///< camera_from_object
  glm::dvec3 center_mm{0.0};  ///< of the object's sphere, in its frame
  double radius_mm = 1.0;     ///< of that sphere
  IcpOptions options;
  double shrink = 1.0;  ///< icpShrink(options)
};

/// Sums over the points: nothing but floats, see HostBlock::sum.
struct PointSums {
  IcpSumsOf<float> icp;
  float pairs;
};

/// Shared by the threads of a block; the leader changes it.
struct IcpShared {
  IcpFrame frame;
  IcpView view;
  IcpResult result;
  bool done;
};

/// The leader's end of an iteration.
RP_BODY void endIteration(const IcpTask& task,
                          const PointSums& sums,
                          const Camera& camera,
                          IcpShared& shared) {
  const bool moved = icpAdvance(shared.result,
                                shared.frame,
                                inDoubles(sums.icp),
                                static_cast<double>(sums.pairs),
                                task.point_count,
                                task.center_mm,
                                task.shrink);
  shared.done = !moved || shared.result.iterations >= task.options.iterations;
  if (!shared.done) shared.view = icpView(shared.frame, task.options, camera);
}

/// `points` are those of all tasks. `read` as in posed_points_core.h.
template <typename Block, typename Read>
RP_BODY void alignPose(Block& block,
                       IcpShared& shared,
                       const IcpTask& task,
                       const Camera& camera,
                       const Read& read,
                       const SurfacePoint* points,
                       IcpResult& answer) {
  block.leader([&] {
    shared.result = {task.start, 0.0, 0.0, 0};
    shared.frame = firstFrame(task.start, task.center_mm, task.radius_mm, task.options);
    shared.view = icpView(shared.frame, task.options, camera);
    shared.done = false;
  });
  block.barrier();
  while (!shared.done) {
    typename Block::template PerThread<PointSums> sums;
    block.forEachThread([&](int thread) {
      PointSums own{};
      for (int i = thread; i < task.point_count; i += Block::kThreads) {
        const SurfacePoint& point = points[task.first_point + i];
        const bool found = addPoints(
            own.icp, shared.view, read, onePoint(point, isAligned(point, task.options)), point.rim);
        if (found) own.pairs += 1.0f;
      }
      sums[thread] = own;
    });
    block.template sum<float>(
        sums, [&](const PointSums& all) { endIteration(task, all, camera, shared); });
  }
  block.leader([&] { answer = shared.result; });
}

}  // namespace rangepose::cuda
