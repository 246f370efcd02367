// Where the points of tasks lie in one array on the device. Those with a name (AlignTask::name)
// come first and stay from call to call, so that they travel once; the others lie behind them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "stages/surface_points.h"

namespace rangepose::cuda {

class PointPlaces {
 public:
  /// With more than `most_kept` points of names before a call, all places are given anew.
  explicit PointPlaces(std::size_t most_kept = 8'000'000) : most_kept_(most_kept) {}

  /// first[i]: index of the first point of tasks[i]. Good until the next call.
  template <typename Task>
  std::vector<int> place(const std::vector<Task>& tasks) {
    if (kept_.size() > most_kept_) {
      first_kept_.clear();
      kept_.clear();
    }
    unmoved_ = kept_.size();
    for (const Task& task : tasks) {
      if (task.name == 0 || first_kept_.contains(task.name)) continue;
      first_kept_[task.name] = static_cast<int>(kept_.size());
      kept_.insert(kept_.end(), task.points->begin(), task.points->end());
    }
    others_.clear();
    std::vector<int> first;
    for (const Task& task : tasks) {
      if (task.name != 0) {
        first.push_back(first_kept_.at(task.name));
        continue;
      }
      first.push_back(static_cast<int>(kept_.size() + others_.size()));
      others_.insert(others_.end(), task.points->begin(), task.points->end());
    }
    return first;
  }

  const std::vector<SurfacePoint>& kept() const { return kept_; }
  /// So many of kept() are where they were before the last call.
  std::size_t unmoved() const { return unmoved_; }
  /// Of the last call.
  const std::vector<SurfacePoint>& others() const { return others_; }

 private:
  std::size_t most_kept_;
  std::unordered_map<std::uint64_t, int> first_kept_;
  std::vector<SurfacePoint> kept_;
  std::size_t unmoved_ = 0;
  std::vector<SurfacePoint> others_;
};

}  // namespace rangepose::cuda
