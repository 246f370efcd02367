#include "sim/drop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "sim/bullet_bin.h"
#include "sim/convex_hull.h"
#include "sim/pour.h"
#include "sim/random.h"

namespace rangepose {
namespace {

constexpr double kPour = 0.12;    // between two layers [s]
constexpr double kStride = 0.25;  // between two looks [s]
constexpr int kStrides = 2;       // in which nothing may move
constexpr double kCalm = 0.5;     // with strong damping before [s]
constexpr Damping kFalling{0.02, 0.1};
constexpr Damping kCalming{0.6, 0.8};
constexpr Damping kResting{0.3, 0.5};

/// The farthest that a point of any part has moved [mm].
double motionBetween(const std::vector<PhysicsPart>& parts,
                     const std::vector<PlacedPart>& before,
                     const std::vector<PlacedPart>& after) {
  double farthest = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Pose& from = before[k].world_from_object;
    const Pose& to = after[k].world_from_object;
    for (const glm::dvec3& corner : parts[static_cast<std::size_t>(before[k].mesh)].hull_mm) {
      farthest = std::max(farthest, glm::distance(from * corner, to * corner));
    }
  }
  return farthest;
}

/// The limits of depth and motion are shares of this.
double smallestDiameter(const std::vector<PhysicsPart>& parts, const std::vector<int>& counts) {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (counts[k] > 0) smallest = std::min(smallest, parts[k].diameter_mm);
  }
  return smallest;
}

/// What a bin that cannot hold its parts says at once, without any simulation.
void checkVolume(const std::vector<PhysicsPart>& parts,
                 const std::vector<int>& counts,
                 const BinShape& bin) {
  constexpr double kDensest = 0.74;  // no heap is denser than stacked spheres, or so
  double volume_mm3 = 0.0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    volume_mm3 += counts[k] * parts[k].mass.volume_mm3;
  }
  const glm::dvec3& side = bin.inner_mm;
  if (volume_mm3 <= kDensest * side.x * side.y * side.z) return;
  throw Error(
      "drop: the parts have more volume than the bin holds; give a larger bin or fewer parts");
}

struct Moment {
  std::vector<PlacedPart> parts;
  double depth_mm = 0.0;
};

/// Runs until nothing has moved for half a second; false at the time limit. What is kept is the
/// bin at the beginning of it: it is known to lie still afterwards.
bool settle(const std::vector<PhysicsPart>& parts,
            const DropOptions& options,
            double smallest_mm,
            BulletBin& world,
            DroppedBin& bin) {
  world.setDamping(kResting);
  std::deque<Moment> moments;  // the last half second
  const int looks = static_cast<int>(std::ceil(options.time_limit_s / kStride));
  for (int look = 0; look <= looks; ++look) {
    if (look > 0) world.run(kStride);
    moments.push_back({world.placed(), world.depthMm()});
    if (moments.size() <= std::size_t{kStrides}) continue;
    const Moment& first = moments.front();
    bin.motion_mm = 0.0;
    for (const Moment& later : moments) {
      bin.motion_mm = std::max(bin.motion_mm, motionBetween(parts, first.parts, later.parts));
    }
    if (bin.motion_mm <= options.max_motion * smallest_mm &&
        first.depth_mm <= options.max_depth * smallest_mm) {
      bin.depth_mm = first.depth_mm;
      if (options.linger_s > 0.0) world.run(std::max(0.0, options.linger_s - kStrides * kStride));
      bin.parts = options.linger_s > 0.0 ? world.placed() : first.parts;
      return true;
    }
    moments.pop_front();
  }
  return false;
}

/// One try. Returns what is wrong with the bin, nothing where it is good.
std::string tryBin(const std::vector<PhysicsPart>& parts,
                   const std::vector<int>& counts,
                   const DropOptions& options,
                   Random& random,
                   DroppedBin& bin) {
  BulletBin world(parts, counts, bin.bin, options.friction);
  Pourer pourer(parts, bin.bin, random);
  const std::vector<int> order = pourer.order(counts);
  for (std::size_t next = 0; next < order.size();) {
    next = pourer.pour(order, next, world);
    world.setDamping(kFalling);
    world.run(kPour);
  }
  world.setFriction(options.rest_friction);
  world.setDamping(kCalming);
  world.run(kCalm);
  const bool fixed_height = options.bin.inner_mm.z > 0.0;
  const double smallest_mm = smallestDiameter(parts, counts);
  const double heap_mm = topOf(parts, world.placed());
  if (fixed_height && heap_mm > bin.bin.inner_mm.z + 0.5 * smallest_mm) {
    return "parts reach over the rim";  // far more than settling could mend
  }
  if (!settle(parts, options, smallest_mm, world, bin)) {
    return "parts still move or share space";
  }
  const double over_mm = topOf(parts, bin.parts) - bin.bin.inner_mm.z;
  if (over_mm <= 0.0) return {};
  if (fixed_height) return "parts reach over the rim";
  bin.bin.inner_mm.z += std::ceil(over_mm);
  return {};
}

void checkCounts(const std::vector<PhysicsPart>& parts, const std::vector<int>& counts) {
  RP_CHECK(parts.size() == counts.size(), "drop: not one count for each part");
  const bool negative = std::any_of(counts.begin(), counts.end(), [](int n) { return n < 0; });
  const bool any = std::any_of(counts.begin(), counts.end(), [](int n) { return n > 0; });
  RP_CHECK(!negative && any, "drop: the number of parts must be at least 1");
}

}  // namespace

void DropOptions::check() const {
  for (int axis = 0; axis < 3; ++axis) {
    RP_CHECK(std::isfinite(bin.inner_mm[axis]) && bin.inner_mm[axis] >= 0.0,
             "drop: a side of the bin is negative or not finite");
  }
  RP_CHECK(friction >= 0.0 && friction <= 2.0, "drop: friction must be 0 to 2");
  RP_CHECK(rest_friction >= 0.0 && rest_friction <= 2.0, "drop: rest_friction must be 0 to 2");
  RP_CHECK(attempts >= 1, "drop: attempts must be at least 1");
  RP_CHECK(max_depth > 0.0 && max_motion > 0.0, "drop: max_depth and max_motion must be positive");
  RP_CHECK(time_limit_s > 0.0 && time_limit_s <= 1e4,
           "drop: time_limit_s must be above 0, at most 1e4");
  RP_CHECK(linger_s >= 0.0 && linger_s <= 1e4, "drop: linger_s must be 0 to 1e4");
}

BinShape binFor(const std::vector<PhysicsPart>& parts,
                const std::vector<int>& counts,
                const BinShape& wanted) {
  checkCounts(parts, counts);
  constexpr double kFilled = 0.45;  // share of a heap that the hulls of its parts take up
  constexpr double kHeight = 1.0;   // of the heap, in mean diameters
  constexpr double kAspect = 4.0 / 3.0;
  double volume = 0.0;
  double largest = 0.0;
  double sum = 0.0;
  int all = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (counts[k] == 0) continue;
    volume += counts[k] * convexHull(parts[k].hull_mm).volume;
    largest = std::max(largest, parts[k].diameter_mm);
    sum += counts[k] * parts[k].diameter_mm;
    all += counts[k];
  }
  const double mean = sum / all;
  const double area = volume / kFilled / (kHeight * mean);
  const double least = 1.6 * largest;
  BinShape bin = wanted;
  glm::dvec3& side = bin.inner_mm;
  const double wanted_y = side.x > 0.0 ? area / side.x : std::sqrt(area / kAspect);
  if (side.y == 0.0) side.y = std::ceil(std::max(least, wanted_y));
  if (side.x == 0.0) side.x = std::ceil(std::max(least, area / side.y));
  if (side.z == 0.0) side.z = std::ceil(1.25 * std::max(largest, kHeight * mean));
  return bin;
}

DroppedBin dropParts(const std::vector<PhysicsPart>& parts,
                     const std::vector<int>& counts,
                     const DropOptions& options) {
  options.check();
  constexpr std::uint64_t kSeedStride =
      0x9E3779B97F4A7C15u;  // far apart, so that bins share no seeds
  const BinShape shape = binFor(parts, counts, options.bin);
  if (options.bin.inner_mm.z > 0.0) checkVolume(parts, counts, shape);
  std::string why;
  for (int attempt = 1; attempt <= options.attempts; ++attempt) {
    DroppedBin bin;
    bin.bin = shape;
    bin.attempts = attempt;
    Random random(options.seed + kSeedStride * static_cast<std::uint64_t>(attempt));
    why = tryBin(parts, counts, options, random, bin);
    if (why.empty()) return bin;
  }
  throw Error("drop: " + why + " in each of " + std::to_string(options.attempts) +
              " bins; give a larger bin or fewer parts");
}

}  // namespace rangepose
