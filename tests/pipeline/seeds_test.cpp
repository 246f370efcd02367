// Where the search starts.
#include "pipeline/seeds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace rangepose {
namespace {

/// Patches with a formula for their EDT values.
class Scene {
 public:
  Scene(int width, int height) {
    channels_.range_px = Image<float>(width, height, 0.0f);
    channels_.edges = Image<float>(width, height, 0.0f);
    channels_.distance_px = Image<float>(width, height, -1.0f);
    labels_ = Image<std::int32_t>(width, height, kNoPatch);
  }

  /// A rectangle; its EDT value is the distance to its border, at most `limit`.
  Scene& patch(const PixelBox& box, float range, float limit) {
    const std::int32_t label = box.y0 * labels_.width() + box.x0;
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const int to_border =
            std::min(std::min(x - box.x0, box.x1 - 1 - x), std::min(y - box.y0, box.y1 - 1 - y));
        labels_.at(x, y) = label;
        channels_.range_px.at(x, y) = range;
        channels_.distance_px.at(x, y) = std::min(limit, static_cast<float>(to_border + 1));
      }
    }
    return *this;
  }

  SceneChannels& channels() { return channels_; }
  std::vector<Seed> seeds(const SeedOptions& options) const {
    return findSeeds(channels_, labels_, options);
  }

 private:
  SceneChannels channels_;
  Image<std::int32_t> labels_;
};

SeedOptions wanting(int count) {
  SeedOptions options;
  options.count = count;
  return options;
}

TEST(SeedsTest, EmptySceneGivesNone) {
  EXPECT_TRUE(Scene(40, 30).seeds(wanting(3)).empty());
  EXPECT_TRUE(Scene(0, 0).seeds(wanting(3)).empty());
}

TEST(SeedsTest, NearestPatchComesFirst) {
  const Scene scene = Scene(60, 20)
                          .patch({0, 0, 9, 9}, 300.0f, 99.0f)
                          .patch({20, 0, 29, 9}, 100.0f, 99.0f)
                          .patch({40, 0, 49, 9}, 200.0f, 99.0f);
  const std::vector<Seed> seeds = scene.seeds(wanting(3));
  ASSERT_EQ(seeds.size(), 3u);
  EXPECT_EQ(seeds[0].range_px, 100.0f);
  EXPECT_EQ(seeds[1].range_px, 200.0f);
  EXPECT_EQ(seeds[2].range_px, 300.0f);
  for (const Seed& seed : seeds) {
    EXPECT_EQ(seed.patch_px, 81);
    EXPECT_EQ(seed.mean_range_px, seed.range_px);
  }
}

TEST(SeedsTest, MeanRangeDecidesNotTheNearestPixel) {
  Scene scene =
      Scene(40, 20).patch({0, 0, 9, 9}, 100.0f, 99.0f).patch({20, 0, 29, 9}, 99.0f, 99.0f);
  scene.channels().range_px.at(1, 1) = 80.0f;
  const std::vector<Seed> seeds = scene.seeds(wanting(2));
  ASSERT_EQ(seeds.size(), 2u);
  EXPECT_EQ(seeds[0].range_px, 99.0f);
  EXPECT_NEAR(seeds[1].mean_range_px, (80.0f * 100.0f + 80.0f) / 81.0f, 1e-3f);
}

TEST(SeedsTest, MostInnerPixelIsTheStart) {
  Scene scene = Scene(40, 30).patch({3, 5, 14, 16}, 120.0f, 99.0f);
  const std::vector<Seed> middle = scene.seeds(wanting(1));
  ASSERT_EQ(middle.size(), 1u);
  EXPECT_EQ(middle[0].x_px, 8.0f);
  EXPECT_EQ(middle[0].y_px, 10.0f);
  EXPECT_EQ(middle[0].distance_px, 6.0f);
  scene.channels().distance_px.at(5, 12) = 9.0f;
  scene.channels().range_px.at(5, 12) = 125.0f;
  const std::vector<Seed> moved = scene.seeds(wanting(1));
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_EQ(moved[0].x_px, 5.0f);
  EXPECT_EQ(moved[0].y_px, 12.0f);
  EXPECT_EQ(moved[0].distance_px, 9.0f);
  EXPECT_EQ(moved[0].range_px, 125.0f);
}

TEST(SeedsTest, TieGoesToTheMiddle) {
  // EDT values stop at 3: all of columns 4..32 of the middle rows tie.
  const std::vector<Seed> seeds =
      Scene(60, 20).patch({2, 2, 35, 11}, 50.0f, 3.0f).seeds(wanting(1));
  ASSERT_EQ(seeds.size(), 1u);
  EXPECT_EQ(seeds[0].x_px, 18.0f);
  EXPECT_EQ(seeds[0].y_px, 6.0f);
}

TEST(SeedsTest, TiedPixelsAroundAHoleGiveAPixelOfThePatch) {
  Scene scene = Scene(60, 20);
  scene.patch({0, 0, 30, 9}, 50.0f, 1.0f);
  scene.channels().distance_px.at(2, 4) = 5.0f;
  scene.channels().distance_px.at(26, 4) = 5.0f;
  scene.channels().distance_px.at(25, 4) = 5.0f;
  const std::vector<Seed> seeds = scene.seeds(wanting(1));
  ASSERT_EQ(seeds.size(), 1u);
  EXPECT_EQ(seeds[0].x_px, 25.0f);
  EXPECT_EQ(seeds[0].y_px, 4.0f);
}

TEST(SeedsTest, MergedPatchGetsFurtherStartsAfterTheFirstOfOthers) {
  SeedOptions options = wanting(5);
  options.max_patch_px = 1000;
  options.apart_px = 25.0f;
  const Scene scene = Scene(160, 60)
                          .patch({0, 0, 110, 20}, 100.0f, 6.0f)   // 2200 px: several parts
                          .patch({0, 30, 20, 50}, 200.0f, 99.0f)  // 400 px: one
                          .patch({40, 30, 60, 50}, 150.0f, 99.0f);
  const std::vector<Seed> seeds = scene.seeds(options);
  ASSERT_EQ(seeds.size(), 5u);
  EXPECT_EQ(seeds[0].range_px, 100.0f);
  EXPECT_EQ(seeds[1].range_px, 150.0f);
  EXPECT_EQ(seeds[2].range_px, 200.0f);
  const std::vector<Seed> merged = {seeds[0], seeds[3], seeds[4]};
  for (std::size_t i = 0; i < merged.size(); ++i) {
    EXPECT_EQ(merged[i].range_px, 100.0f);
    EXPECT_GE(merged[i].distance_px, options.min_distance_px);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(std::hypot(merged[i].x_px - merged[j].x_px, merged[i].y_px - merged[j].y_px),
                options.apart_px);
    }
  }
}

TEST(SeedsTest, FurtherStartsKeepOffTheBorder) {
  SeedOptions options = wanting(50);
  options.max_patch_px = 100;
  options.apart_px = 12.0f;
  const std::vector<Seed> seeds = Scene(80, 30).patch({0, 0, 70, 20}, 100.0f, 99.0f).seeds(options);
  EXPECT_GE(seeds.size(), 4u);
  EXPECT_LE(seeds.size(), 16u);
  for (const Seed& seed : seeds) EXPECT_GE(seed.distance_px, options.min_distance_px);
}

TEST(SeedsTest, OrdinaryPatchGetsOneStart) {
  SeedOptions options = wanting(10);
  options.max_patch_px = 2200;
  options.apart_px = 10.0f;
  EXPECT_EQ(Scene(160, 60).patch({0, 0, 110, 20}, 100.0f, 6.0f).seeds(options).size(), 1u);
}

TEST(SeedsTest, SmallPatchesOnlyWhenLargerOnesAreTooFew) {
  const Scene scene = Scene(80, 40)
                          .patch({0, 0, 9, 9}, 300.0f, 99.0f)
                          .patch({20, 0, 24, 4}, 100.0f, 99.0f)  // 16 px
                          .patch({40, 0, 44, 3}, 50.0f, 99.0f)   // 12 px
                          .patch({0, 20, 60, 22}, 20.0f, 99.0f)  // 120 px, but thin: EDT 1
                          .patch({20, 10, 29, 19}, 310.0f, 99.0f);
  const std::vector<Seed> two = scene.seeds(wanting(2));
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].range_px, 300.0f);
  EXPECT_EQ(two[1].range_px, 310.0f);
  SeedOptions options = wanting(9);
  options.apart_px = 5.0f;
  const std::vector<Seed> all = scene.seeds(options);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[2].patch_px, 120);
  EXPECT_EQ(all[3].patch_px, 16);
  EXPECT_EQ(all[4].patch_px, 12);
}

/// Otherwise something large in front takes all starts, and the part behind it gets none.
TEST(SeedsTest, SmallPatchAndMoreOfALargeOneTakeTurns) {
  const Scene scene = Scene(200, 60)
                          .patch({0, 0, 110, 40}, 100.0f, 20.0f)
                          .patch({160, 20, 165, 25}, 300.0f, 99.0f)  // far from all starts
                          .patch({60, 42, 65, 47}, 300.0f, 99.0f);   // beside one
  SeedOptions options = wanting(3);
  options.max_patch_px = 2000;
  options.min_patch_px = 30;
  const std::vector<Seed> seeds = scene.seeds(options);
  ASSERT_EQ(seeds.size(), 3u);
  EXPECT_EQ(seeds[0].range_px, 100.0f);
  EXPECT_EQ(seeds[1].range_px, 100.0f);
  EXPECT_EQ(seeds[2].x_px, 162.0f);  // its middle
}

TEST(SeedsTest, CountIsRespected) {
  Scene scene(200, 20);
  for (int i = 0; i < 10; ++i)
    scene.patch({20 * i, 0, 20 * i + 9, 9}, 100.0f + static_cast<float>(i), 99.0f);
  for (const int count : {1, 3, 10})
    EXPECT_EQ(scene.seeds(wanting(count)).size(), static_cast<std::size_t>(count));
  EXPECT_EQ(scene.seeds(wanting(40)).size(), 10u);
}

}  // namespace
}  // namespace rangepose
