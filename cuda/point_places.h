// Where the points of tasks lie in one array on the device. Those that are kept (AlignTask::kept)
// come first and stay from call to call, so that they travel once; the others lie behind them.
#pragma once

#include <unordered_map>
#include <vector>

#include "stages/surface_points.h"

namespace rangepose::cuda {

class PointPlaces {
 public:
  /// first[i]: index of the first point of tasks[i]. Good until the next call.
  template <typename Task>
  std::vector<int> place(const std::vector<Task>& tasks) {
    for (const Task& task : tasks) {
      if (!task.kept || first_kept_.contains(task.points)) continue;
      first_kept_[task.points] = static_cast<int>(kept_.size());
      kept_.insert(kept_.end(), task.points->begin(), task.points->end());
    }
    others_.clear();
    std::vector<int> first;
    for (const Task& task : tasks) {
      if (task.kept) {
        first.push_back(first_kept_.at(task.points));
        continue;
      }
      first.push_back(static_cast<int>(kept_.size() + others_.size()));
      others_.insert(others_.end(), task.points->begin(), task.points->end());
    }
    return first;
  }

  const std::vector<SurfacePoint>& kept() const { return kept_; }
  /// Of the last call.
  const std::vector<SurfacePoint>& others() const { return others_; }

 private:
  std::unordered_map<const std::vector<SurfacePoint>*, int> first_kept_;
  std::vector<SurfacePoint> kept_;
  std::vector<SurfacePoint> others_;
};

}  // namespace rangepose::cuda
