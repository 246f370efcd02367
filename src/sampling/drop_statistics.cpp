#include "sampling/drop_statistics.h"

#include <algorithm>
#include <mutex>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/drop.h"
#include "sim/random.h"

namespace rangepose {
namespace {

/// The camera looks down: its z is the bin's -z, its x the bin's x.
const glm::dmat3 kCameraFromBin{1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0};

std::vector<glm::dmat3> restingIn(const PhysicsPart& part, int count, std::uint64_t seed) {
  DropOptions options;
  options.seed = seed;
  // A part that still creeps, or presses into another, lies as it will lie.
  options.max_motion = 0.03;
  options.max_depth = 0.03;
  std::vector<glm::dmat3> rotations;
  for (const PlacedPart& placed : dropParts({part}, {count}, options).parts) {
    rotations.push_back(kCameraFromBin * placed.world_from_object.rotation);
  }
  return rotations;
}

/// At most kMostKeptRotations, evenly spread over the bins.
std::vector<glm::dmat3> selection(const std::vector<glm::dmat3>& rotations) {
  const std::size_t kept = std::min(rotations.size(), kMostKeptRotations);
  std::vector<glm::dmat3> chosen;
  chosen.reserve(kept);
  for (std::size_t i = 0; i < kept; ++i) chosen.push_back(rotations[i * rotations.size() / kept]);
  return chosen;
}

}  // namespace

void DropStatisticsOptions::check() const {
  RP_CHECK(bins >= 1 && bins <= 100000, "pose statistics: bins must be in 1..100000");
  RP_CHECK(fewest_parts >= 1 && most_parts >= fewest_parts && most_parts <= 1000,
           "pose statistics: parts of a bin must be in 1..1000");
}

PoseStatistics simulateStatistics(const Mesh& mesh,
                                  const DropStatisticsOptions& options,
                                  const std::function<void(int done)>& progress) {
  options.check();
  const PhysicsPart part = physicsPart(mesh);
  std::vector<std::vector<glm::dmat3>> by_bin(static_cast<std::size_t>(options.bins));
  std::mutex mutex;
  int done = 0;
  int failed = 0;
  std::string reason;
  parallelFor(options.bins, 1, [&](int bin, int) {
    Random random(options.seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(bin));
    const int range = options.most_parts - options.fewest_parts + 1;
    const int count = options.fewest_parts + static_cast<int>(random.uniform() * range);
    std::string problem;
    try {
      const std::uint64_t seed = static_cast<std::uint64_t>(random.uniform() * 0x1.0p53);
      by_bin[static_cast<std::size_t>(bin)] = restingIn(part, count, seed);
    } catch (const Error& error) {
      problem = error.what();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    if (!problem.empty()) {
      ++failed;
      reason = problem;
    }
    ++done;
    if (progress) progress(done);
  });
  if (10 * failed > options.bins) {
    throw Error("mesh " + mesh.name + ": " + std::to_string(failed) + " of " +
                std::to_string(options.bins) + " simulated bins failed (" + reason + ")");
  }
  std::vector<glm::dmat3> all;
  for (const auto& rotations : by_bin) all.insert(all.end(), rotations.begin(), rotations.end());
  PoseStatistics statistics;
  statistics.seed = options.seed;
  statistics.bins = options.bins;
  statistics.parts = static_cast<std::int32_t>(all.size());
  statistics.rotations = selection(all);
  return statistics;
}

}  // namespace rangepose
