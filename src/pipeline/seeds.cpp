#include "pipeline/seeds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rangepose {
namespace {

struct Patch {
  int pixels = 0;
  double range_sum = 0.0;
  float largest = 0.0f;
  int tied = 0;
  double tied_x = 0.0;
  double tied_y = 0.0;
  Seed seed;
  double nearest_sq = std::numeric_limits<double>::max();
};

void addPixel(Patch& patch, int x, int y, float range, float distance) {
  ++patch.pixels;
  patch.range_sum += static_cast<double>(range);
  if (distance < patch.largest) return;
  if (distance > patch.largest) {
    patch.largest = distance;
    patch.tied = 0;
    patch.tied_x = 0.0;
    patch.tied_y = 0.0;
  }
  ++patch.tied;
  patch.tied_x += x;
  patch.tied_y += y;
}

void offerSeed(Patch& patch, int x, int y, float range, float distance) {
  if (distance != patch.largest) return;
  const double dx = x - patch.tied_x / patch.tied;
  const double dy = y - patch.tied_y / patch.tied;
  const double squared = dx * dx + dy * dy;
  if (squared >= patch.nearest_sq) return;
  patch.nearest_sq = squared;
  patch.seed = {static_cast<float>(x), static_cast<float>(y), range, distance, 0.0f, 0};
}

template <typename Visit>
void forEachPixel(const SceneChannels& scene, const Image<std::int32_t>& labels, const Visit& visit) {
  for (int y = 0; y < labels.height(); ++y) {
    for (int x = 0; x < labels.width(); ++x) {
      const std::int32_t label = labels.at(x, y);
      if (label != kNoPatch) visit(label, x, y, scene.range_px.at(x, y), scene.distance_px.at(x, y));
    }
  }
}

}  // namespace

std::vector<Seed> findSeeds(const SceneChannels& scene,
                            const Image<std::int32_t>& labels,
                            const SeedOptions& options) {
  std::map<std::int32_t, Patch> patches;
  forEachPixel(scene, labels, [&](std::int32_t label, int x, int y, float range, float distance) {
    addPixel(patches[label], x, y, range, distance);
  });
  forEachPixel(scene, labels, [&](std::int32_t label, int x, int y, float range, float distance) {
    offerSeed(patches[label], x, y, range, distance);
  });
  std::vector<Seed> seeds;
  std::vector<Seed> small;
  for (auto& [label, patch] : patches) {
    patch.seed.mean_range_px = static_cast<float>(patch.range_sum / patch.pixels);
    patch.seed.patch_px = patch.pixels;
    const bool large = patch.pixels >= options.min_patch_px && patch.largest >= options.min_distance_px;
    (large ? seeds : small).push_back(patch.seed);
  }
  if (seeds.empty()) seeds = small;
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return a.mean_range_px < b.mean_range_px;
  });
  if (static_cast<int>(seeds.size()) > options.count) {
    seeds.resize(static_cast<std::size_t>(std::max(options.count, 0)));
  }
  return seeds;
}

}  // namespace rangepose
