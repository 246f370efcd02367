// Adds up how far the values of one stage lie apart on two paths.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "compare/compare.h"

namespace rangepose {

/// How far apart the values of a stage may be; the table is in tally.cpp.
struct StageTolerance {
  const char* unit = "";
  double each = 0.0;   ///< of one value [unit]
  double share = 0.0;  ///< of the values that may be farther apart, 0..1
};

/// Throws Error for a stage that is not in the table.
StageTolerance toleranceOf(const std::string& stage);

/// Difference that stands for "not comparable": a value that is not finite or is missing on one
/// side.
inline constexpr double kIncomparable = 1.0e6;

class Tally {
 public:
  Tally(const std::string& stage, const std::string& path);

  /// `difference` >= 0 in the stage's unit.
  void add(double difference);
  /// `count` values that only one side has.
  void addMissing(std::int64_t count);
  void addTimes(double reference_ms, double path_ms);

  /// Pixel by pixel; `difference(a, b)` of two pixels.
  template <typename T, typename Difference>
  void addImages(const Image<T>& reference, const Image<T>& subject, const Difference& difference) {
    if (reference.width() != subject.width() || reference.height() != subject.height()) {
      addMissing(static_cast<std::int64_t>(std::max(reference.size(), subject.size())));
      return;
    }
    for (std::size_t i = 0; i < reference.size(); ++i) {
      add(difference(reference.data()[i], subject.data()[i]));
    }
  }
  void addImages(const Image<float>& reference, const Image<float>& subject);
  /// Pixels that are the same or are not.
  template <typename T>
  void addLabels(const Image<T>& reference, const Image<T>& subject) {
    addImages(reference, subject, [](const T& a, const T& b) { return a == b ? 0.0 : 1.0; });
  }

  /// Runs `stage` on both paths, timed. Before its first time on the subject it runs once untimed,
  /// for what a path makes once.
  template <typename Stage>
  auto run(StageSet& reference, StageSet& subject, const Stage& stage) {
    if (!warm_) static_cast<void>(stage(subject));
    warm_ = true;
    const auto begin = std::chrono::steady_clock::now();
    auto expected = stage(reference);
    const auto middle = std::chrono::steady_clock::now();
    auto actual = stage(subject);
    const auto end = std::chrono::steady_clock::now();
    using Ms = std::chrono::duration<double, std::milli>;
    addTimes(Ms(middle - begin).count(), Ms(end - middle).count());
    return std::pair(std::move(expected), std::move(actual));
  }

  StageComparison result() const;

 private:
  StageTolerance tolerance_;
  StageComparison result_;
  double sum_ = 0.0;
  bool warm_ = false;
};

/// How many more one of two lists holds that should be equally long.
std::int64_t surplus(std::size_t a, std::size_t b);

/// |a - b| as a share of |a|, or of `floor` where |a| is smaller.
double relativeDifference(double a, double b, double floor);

}  // namespace rangepose
