#include "stages/sensor_facts_host.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/parallel.h"
#include "stages/noise_core.h"
#include "stages/relief_core.h"

namespace rangepose::host {
namespace {

/// Every twelfth row and column is enough.
constexpr int kLineStep = 12;

/// A row or a column of depths [mm].
struct Line {
  const float* first;
  std::ptrdiff_t stride;
  int length;
  float operator[](int i) const { return first[i * stride]; }
};

template <typename Use>
void forEachLine(const Image<float>& depth_mm, const Use& use) {
  for (int v = 0; v < depth_mm.height(); v += kLineStep)
    use(Line{depth_mm.row(v), 1, depth_mm.width()});
  for (int u = 0; u < depth_mm.width(); u += kLineStep)
    use(Line{depth_mm.row(0) + u, depth_mm.width(), depth_mm.height()});
}

/// Where depth has no steps, an eighth of the second differences that are not zero lies below a
/// small part of the noise; where it has, they are whole numbers of steps.
double depthStep(const Image<float>& depth_mm) {
  constexpr float kZeroMm = 1e-3f;
  std::vector<float> differences;
  forEachLine(depth_mm, [&](const Line& line) {
    for (int i = kNoiseApart; i + kNoiseApart < line.length; i += kNoiseApart) {
      const float difference =
          secondDifference(line[i - kNoiseApart], line[i], line[i + kNoiseApart]);
      if (difference > kZeroMm) differences.push_back(difference);
    }
  });
  if (differences.size() < kNoiseFewest) return 0.0;
  const auto eighth = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 8);
  std::nth_element(differences.begin(), eighth, differences.end());
  return static_cast<double>(*eighth);
}

/// How often each number of pixels came.
class PixelCounts {
 public:
  void add(int pixels) {
    ++counts_[std::min(static_cast<std::size_t>(pixels), counts_.size() - 1)];
    sum_ += pixels;
    ++all_;
  }
  bool few() const { return all_ < 50; }
  double mean() const { return static_cast<double>(sum_) / all_; }
  /// Numbers of pixels stand for half a pixel to both sides.
  double median() const {
    double below = 0.0;
    std::size_t i = 0;
    for (; below + counts_[i] < 0.5 * all_; ++i) below += counts_[i];
    const double within = (0.5 * all_ - below) / counts_[i];
    return std::max(0.0, static_cast<double>(i) - 0.5 + within);
  }

 private:
  std::array<int, 32> counts_{};
  int sum_ = 0;
  int all_ = 0;
};

constexpr int kReach = 12;  // px from the middle of a jump to what is level
constexpr int kLevel = 4;   // px that show that it is

/// A jump of depth that passes its middle between pixel `at` and the next measured one.
struct Jump {
  int smeared = 0;  ///< px
  int lost = 0;     ///< px
};

/// False where there is none, or it does not lead from one level surface to another.
bool jumpAt(const Line& line, int at, double least_mm, Jump& jump) {
  constexpr float kLevelShare = 0.15f;
  const float near = line[at - kReach];
  const float far = line[at + kReach];
  const float size = std::abs(far - near);
  if (!(size > least_mm) || line[at] == 0.0f) return false;
  const float per_px = kLevelShare * size * kLevel / kReach;
  if (std::abs(near - line[at - kReach - kLevel]) > per_px ||
      std::abs(far - line[at + kReach + kLevel]) > per_px)
    return false;
  const auto share = [&](int i) { return (line[i] - near) / (far - near); };
  int next = at + 1;
  while (next < at + kReach && line[next] == 0.0f) ++next;
  if (!(share(at) < 0.5f && share(next) >= 0.5f)) return false;
  jump = {};
  for (int i = at - kReach; i <= at + kReach; ++i) {
    if (line[i] == 0.0f) {
      ++jump.lost;
      continue;
    }
    const float here = share(i);
    if (here < -0.2f || here > 1.2f || (here > 0.5f) != (i > at)) return false;
    if (here > kLevelShare && here < 1.0f - kLevelShare) ++jump.smeared;
  }
  return true;
}

constexpr int kHalf = 9;  // of a window; its pixels are 3 apart
constexpr int kPixelStep = 3;
constexpr int kMiddles = 40;  // windows along the image's width, at most

/// What the best quadric leaves of the window [mm]; -1 where too little of it was measured.
double deviationAround(const Image<float>& depth_mm, int u, int v) {
  constexpr double kFewest = 36.0;  // of 49 pixels
  const float middle_mm = depth_mm.at(u, v);
  if (middle_mm == 0.0f) return -1.0;
  ReliefSums sums;
  for (int y = -kHalf; y <= kHalf; y += kPixelStep) {
    const float* row = depth_mm.row(v + y) + u;
    for (int x = -kHalf; x <= kHalf; x += kPixelStep) {
      if (row[x] == 0.0f) continue;
      sums.add(static_cast<double>(x) / kHalf,
               static_cast<double>(y) / kHalf,
               static_cast<double>(row[x] - middle_mm),
               0.0,
               1.0);
    }
  }
  if (sums.count < kFewest) return -1.0;
  return std::sqrt(quadricResidual(sums) / (sums.count - ReliefSums::kTerms));
}

/// Of smooth windows: of all of them the two fifths that a quadric fits best are taken for smooth.
double errorOfWindows(const Image<float>& depth_mm) {
  constexpr std::size_t kFewest = 20;
  const int apart = std::max(16, depth_mm.width() / kMiddles);
  const int across = (depth_mm.width() - 2 * kHalf - 1) / apart + 1;
  const int down = (depth_mm.height() - 2 * kHalf - 1) / apart + 1;
  if (depth_mm.width() <= 2 * kHalf || depth_mm.height() <= 2 * kHalf) return 0.0;
  std::vector<double> deviations(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  parallelForEach(static_cast<std::size_t>(down), 4, [&](std::size_t y) {
    for (int x = 0; x < across; ++x) {
      deviations[y * static_cast<std::size_t>(across) + static_cast<std::size_t>(x)] =
          deviationAround(depth_mm, kHalf + x * apart, kHalf + static_cast<int>(y) * apart);
    }
  });
  std::erase_if(deviations, [](double one) { return one < 0.0; });
  if (deviations.size() < kFewest) return 0.0;
  const auto at = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() * 2 / 5);
  std::nth_element(deviations.begin(), at, deviations.end());
  return *at;
}

}  // namespace

SensorFacts sensorFacts(const DepthImage& image, double between_neighbours_mm) {
  constexpr double kLeastJumpMm = 10.0;
  constexpr double kLeastJumpNoise = 20.0;
  SensorFacts facts;
  facts.step_mm = depthStep(image.depth_mm);
  // Errors of rounding are even over a step.
  facts.noise_mm = std::hypot(between_neighbours_mm, facts.step_mm / std::sqrt(12.0));
  // Where nothing but parts is seen no window is smooth: what is left of them is no error.
  constexpr double kMostShared = 3.0;
  facts.error_mm =
      std::clamp(errorOfWindows(image.depth_mm), facts.noise_mm, kMostShared * facts.noise_mm);
  const double least_mm = std::max(kLeastJumpMm, kLeastJumpNoise * facts.noise_mm);
  PixelCounts smeared;
  PixelCounts holes;
  int between = 0;
  int lost = 0;
  constexpr int kMargin = kReach + kLevel;
  forEachLine(image.depth_mm, [&](const Line& line) {
    for (int i = kMargin; i + kMargin < line.length; ++i) {
      if (line[i - kMargin] == 0.0f || line[i - kReach] == 0.0f || line[i + kReach] == 0.0f ||
          line[i + kMargin] == 0.0f)
        continue;
      ++between;
      if (line[i] == 0.0f) ++lost;
      Jump jump;
      if (!jumpAt(line, i, least_mm, jump)) continue;
      smeared.add(jump.smeared);
      holes.add(jump.lost);
    }
  });
  if (between > 0) facts.lost = static_cast<double>(lost) / between;
  if (smeared.few()) return facts;
  facts.jump_px = smeared.median();
  facts.hole_px = holes.mean();
  return facts;
}

}  // namespace rangepose::host
