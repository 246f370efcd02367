#include "pipeline/seeds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace rangepose {
namespace {

constexpr int kMaxStartsPerPatch = 16;

struct Pixel {
  int x;
  int y;
  float range_px;
  float distance_px;
};
using Patch = std::vector<Pixel>;

/// Patches in the order of their first pixels.
std::vector<Patch> collectPatches(const SceneChannels& scene, const Image<std::int32_t>& labels) {
  std::vector<Patch> patches;
  std::unordered_map<std::int32_t, std::size_t> index;
  for (int y = 0; y < labels.height(); ++y) {
    for (int x = 0; x < labels.width(); ++x) {
      const std::int32_t label = labels.at(x, y);
      if (label == kNoPatch) continue;
      const std::size_t at = index.try_emplace(label, patches.size()).first->second;
      if (at == patches.size()) patches.emplace_back();
      patches[at].push_back({x, y, scene.range_px.at(x, y), scene.distance_px.at(x, y)});
    }
  }
  return patches;
}

float squaredDistance(const Pixel& pixel, float x, float y) {
  const float dx = static_cast<float>(pixel.x) - x;
  const float dy = static_cast<float>(pixel.y) - y;
  return dx * dx + dy * dy;
}

/// The most inner pixel of a patch that is not empty.
Pixel mostInner(const Patch& patch) {
  float largest = std::numeric_limits<float>::lowest();
  for (const Pixel& pixel : patch) largest = std::max(largest, pixel.distance_px);
  float x = 0.0f;
  float y = 0.0f;
  float tied = 0.0f;
  for (const Pixel& pixel : patch) {
    if (pixel.distance_px != largest) continue;
    x += static_cast<float>(pixel.x);
    y += static_cast<float>(pixel.y);
    tied += 1.0f;
  }
  x /= tied;
  y /= tied;
  Pixel best{};
  float nearest = std::numeric_limits<float>::max();
  for (const Pixel& pixel : patch) {
    if (pixel.distance_px != largest || squaredDistance(pixel, x, y) >= nearest) continue;
    nearest = squaredDistance(pixel, x, y);
    best = pixel;
  }
  return best;
}

float meanRange(const Patch& patch, const Pixel& around, float radius_px) {
  double sum = 0.0;
  int count = 0;
  for (const Pixel& pixel : patch) {
    const float x = static_cast<float>(around.x);
    const float y = static_cast<float>(around.y);
    if (squaredDistance(pixel, x, y) > radius_px * radius_px) continue;
    sum += static_cast<double>(pixel.range_px);
    ++count;
  }
  return static_cast<float>(sum / count);
}

/// A start and how many came before it in its patch.
struct RankedSeed {
  Seed seed;
  int round = 0;
  bool small = false;
};

void addSeeds(const Patch& patch, const SeedOptions& options, std::vector<RankedSeed>& seeds) {
  const int size = static_cast<int>(patch.size());
  const bool several = size > options.max_patch_px;
  const float around_px = several ? 0.5f * options.apart_px : std::numeric_limits<float>::max();
  Patch rest = patch;
  for (int i = 0; i < (several ? kMaxStartsPerPatch : 1) && !rest.empty(); ++i) {
    const Pixel inner = mostInner(rest);
    if (i > 0 && inner.distance_px < options.min_distance_px) return;
    const float x = static_cast<float>(inner.x);
    const float y = static_cast<float>(inner.y);
    seeds.push_back(
        {{x, y, inner.range_px, inner.distance_px, meanRange(patch, inner, around_px), size},
         i,
         false});
    std::erase_if(rest, [&](const Pixel& pixel) {
      return squaredDistance(pixel, x, y) < options.apart_px * options.apart_px;
    });
  }
}

bool isApart(const std::vector<Seed>& seeds, const Seed& seed, float apart_px) {
  return std::none_of(seeds.begin(), seeds.end(), [&](const Seed& other) {
    const float dx = other.x_px - seed.x_px;
    const float dy = other.y_px - seed.y_px;
    return dx * dx + dy * dy < apart_px * apart_px;
  });
}

/// The first starts of all patches, nearest first. Then further starts of patches too large for one
/// part and small patches in turn, the largest first: of a part that is mostly hidden there is
/// nothing else, and what hides it may be large.
std::vector<Seed> inTurn(std::vector<RankedSeed>& all, const SeedOptions& options) {
  const auto first_small = std::stable_partition(
      all.begin(), all.end(), [](const RankedSeed& ranked) { return !ranked.small; });
  std::stable_sort(all.begin(), first_small, [](const RankedSeed& a, const RankedSeed& b) {
    return std::pair(a.round, a.seed.mean_range_px) < std::pair(b.round, b.seed.mean_range_px);
  });
  std::stable_sort(first_small, all.end(), [](const RankedSeed& a, const RankedSeed& b) {
    return a.seed.patch_px > b.seed.patch_px;
  });
  std::vector<Seed> seeds;
  auto large = all.begin();
  auto small = first_small;
  bool turn_of_small = false;
  while (static_cast<int>(seeds.size()) < options.count) {
    while (small != all.end() && !isApart(seeds, small->seed, options.apart_px)) ++small;
    if (large == first_small && small == all.end()) break;
    const bool take_large = large != first_small && (large->round == 0 || !turn_of_small);
    if (take_large || small == all.end()) {
      turn_of_small = large->round > 0;
      seeds.push_back((large++)->seed);
    } else {
      turn_of_small = false;
      seeds.push_back((small++)->seed);
    }
  }
  return seeds;
}

}  // namespace

std::vector<Seed> findSeeds(const SceneChannels& scene,
                            const Image<std::int32_t>& labels,
                            const SeedOptions& options) {
  std::vector<RankedSeed> all;
  for (const Patch& patch : collectPatches(scene, labels)) addSeeds(patch, options, all);
  for (RankedSeed& candidate : all) {
    candidate.small = candidate.seed.patch_px < options.min_patch_px ||
                      candidate.seed.distance_px < options.min_distance_px;
  }
  return inTurn(all, options);
}

}  // namespace rangepose
