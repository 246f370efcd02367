// Wall-clock times of named stages.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace rangepose {

struct StageTime {
  std::string stage;
  double ms = 0.0;
};
using StageTimes = std::vector<StageTime>;

/// Adds the time of its own life to `times` under `stage`; the same name adds up.
class ScopedTimer {
 public:
  ScopedTimer(StageTimes& times, std::string stage)
      : times_(times), stage_(std::move(stage)), begin_(std::chrono::steady_clock::now()) {}
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;
  ~ScopedTimer() {
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin_;
    for (StageTime& time : times_) {
      if (time.stage == stage_) {
        time.ms += ms.count();
        return;
      }
    }
    times_.push_back({stage_, ms.count()});
  }

 private:
  StageTimes& times_;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace rangepose
