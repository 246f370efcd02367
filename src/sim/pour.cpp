#include "sim/pour.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"

namespace rangepose {
namespace {

constexpr double kSpeed = 600.0;  // at which a part is let go [mm/s]
constexpr double kSpin = 6.0;     // likewise, about each axis at most [rad/s]
constexpr int kPlaces = 12;       // tried before the layer counts as full
constexpr int kTurns = 1000;      // tried before a part counts as too wide

struct Taken {
  glm::dvec2 at;
  double reach_mm;
};

bool isFree(const std::vector<Taken>& taken, const glm::dvec2& at, double reach_mm) {
  return std::all_of(taken.begin(), taken.end(), [&](const Taken& other) {
    return glm::distance(at, other.at) > reach_mm + other.reach_mm;
  });
}

}  // namespace

std::vector<int> Pourer::order(const std::vector<int>& counts) {
  std::vector<int> order;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    order.insert(order.end(), static_cast<std::size_t>(counts[k]), static_cast<int>(k));
  }
  for (std::size_t k = order.size(); k > 1; --k) {
    const auto other = static_cast<std::size_t>(random_.uniform() * static_cast<double>(k));
    std::swap(order[k - 1], order[other]);
  }
  return order;
}

std::size_t Pourer::pour(const std::vector<int>& order, std::size_t next, BulletBin& world) {
  std::vector<Taken> taken;
  const double top_mm = topOf(parts_, world.placed());
  for (; next < order.size(); ++next) {
    const PhysicsPart& part = parts_[static_cast<std::size_t>(order[next])];
    Start start;
    bool found = false;
    for (int k = 0; k < kPlaces && !found; ++k) {
      start = randomStart(part);
      found = isFree(taken, start.at, part.reach_mm);
    }
    if (!found) break;
    taken.push_back({start.at, part.reach_mm});
    release(order[next], start, top_mm + 1.05 * part.reach_mm, world);
  }
  return next;
}

/// A random orientation at a random place between the walls. Only in a bin that is hardly wider
/// than the part does an orientation have to be drawn again.
Pourer::Start Pourer::randomStart(const PhysicsPart& part) {
  const double gap_mm = 0.02 * part.diameter_mm;
  for (int k = 0; k < kTurns; ++k) {
    Start start{random_.rotation(), glm::dvec2(0.0)};
    glm::dvec2 low(0.0);
    glm::dvec2 high(0.0);
    for (const glm::dvec3& corner : part.hull_mm) {
      const glm::dvec2 offset(start.rotation * (corner - part.mass.center_mm));
      low = glm::min(low, offset);
      high = glm::max(high, offset);
    }
    const glm::dvec2 from = -0.5 * glm::dvec2(bin_.inner_mm) - low + gap_mm;
    const glm::dvec2 to = 0.5 * glm::dvec2(bin_.inner_mm) - high - gap_mm;
    if (from.x > to.x || from.y > to.y) continue;
    start.at.x = random_.uniform(from.x, to.x);
    start.at.y = random_.uniform(from.y, to.y);
    return start;
  }
  throw Error("drop: part " + part.name + " does not fit into a bin of " +
              std::to_string(std::lround(bin_.inner_mm.x)) + " x " +
              std::to_string(std::lround(bin_.inner_mm.y)) + " mm; give a larger bin");
}

void Pourer::release(int index, const Start& start, double height_mm, BulletBin& world) {
  const PhysicsPart& part = parts_[static_cast<std::size_t>(index)];
  Pose pose;
  pose.rotation = start.rotation;
  pose.translation_mm = glm::dvec3(start.at, height_mm) - start.rotation * part.mass.center_mm;
  glm::dvec3 spin;
  for (int axis = 0; axis < 3; ++axis) spin[axis] = random_.uniform(-kSpin, kSpin);
  world.add(index, pose, kSpeed, spin);
}

}  // namespace rangepose
