// The bodies of the image kernels, run on the host, against the host's stages: bit for bit.
#include "cuda/image_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include "cuda/edt_body.h"
#include "cuda/patches_body.h"
#include "stages/channels_host.h"
#include "stages/resample_host.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::awkwardScenes;
using test::RangeScene;

constexpr float kThresholdPx = 2.56f;

auto readerOf(const Image<float>& image) {
  return [&image](int x, int y) { return image.at(x, y); };
}

/// Order in which the threads of a kernel may happen to come.
std::vector<int> shuffled(std::size_t count, unsigned seed) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  test::Random random(seed);
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.index(static_cast<int>(i)))]);
  }
  return order;
}

TEST(ImageBodyTest, MedianAndEdgesAreTheHosts) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float>& range = scene.range_px;
    const int width = range.width();
    const int height = range.height();
    Image<float> median(width, height, -1.0f);
    Image<float> edges(width, height, -1.0f);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        median.at(x, y) = cuda::medianPixel(x, y, width, height, readerOf(range));
        edges.at(x, y) = cuda::edgePixel(x, y, width, height, readerOf(range), kThresholdPx);
      }
    }
    EXPECT_EQ(median, host::median(range)) << scene.name;
    EXPECT_EQ(edges, host::edges(range, kThresholdPx)) << scene.name;
  }
}

Image<float> distanceByTiles(const Image<float>& range, const Image<float>& edges, int passes) {
  Image<float> result(range.width(), range.height(), 1.0e9f);
  auto shared = std::make_unique<cuda::EdtShared>();
  cuda::HostBlock<64> block;
  for (int y0 = 0; y0 < range.height(); y0 += cuda::kEdtTile) {
    for (int x0 = 0; x0 < range.width(); x0 += cuda::kEdtTile) {
      const cuda::EdtTileSetup tile = {x0, y0, range.width(), range.height(), passes};
      cuda::edtTile(block,
                    *shared,
                    tile,
                    readerOf(range),
                    readerOf(edges),
                    [&](int x, int y, const EdtTexel& texel) { result.at(x, y) = edtRoot(texel); });
    }
  }
  return result;
}

TEST(ImageBodyTest, TilesGiveTheDistancesOfTheWholeImage) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host::edges(scene.range_px, kThresholdPx);
    for (const int passes : {1, 7, 15, cuda::kEdtTilePasses}) {
      EXPECT_EQ(distanceByTiles(scene.range_px, edges, passes),
                host::distance(scene.range_px, edges, passes))
          << scene.name << ", passes " << passes;
    }
  }
}

TEST(ImageBodyTest, SitesCrossTilesAsFarAsThePasses) {
  Image<float> edges(96, 96, 0.0f);
  edges.at(31, 40) = 1.0f;
  const Image<float> range(96, 96, 90.0f);
  const Image<float> distance = distanceByTiles(range, edges, 15);
  EXPECT_EQ(distance, host::distance(range, edges, 15));
  EXPECT_EQ(distance.at(46, 40), 15.0f);
  EXPECT_EQ(distance.at(47, 40), 16.0f) << "not reached: clamped to passes + 1";
}

Image<float> splatted(const DepthImage& image, const OrthoCamera& camera, unsigned seed) {
  const ResampleSetup setup = resampleSetup(image.camera, camera);
  Image<unsigned> nearest(camera.width, camera.height, cuda::kNoSplat);
  for (const int index : shuffled(image.depth_mm.size(), seed)) {
    const int u = index % image.camera.width;
    const int v = index / image.camera.width;
    cuda::splatPixel(
        setup,
        u,
        v,
        image.depth_mm.at(u, v),
        camera.width,
        camera.height,
        [&](int at, unsigned bits) { nearest.data()[at] = std::min(nearest.data()[at], bits); });
  }
  Image<float> range(camera.width, camera.height);
  std::transform(nearest.begin(), nearest.end(), range.begin(), cuda::rangeOfSplats);
  return range;
}

TEST(ImageBodyTest, SplatsInAnyOrderAreTheHosts) {
  DepthImage image;
  image.camera.width = 97;
  image.camera.height = 71;
  image.camera.fx = 571.3;
  image.camera.fy = 568.9;
  image.camera.cx = 48.2;
  image.camera.cy = 36.2;
  image.depth_mm = test::randomBlobs(97, 71, 3);
  for (float& depth : image.depth_mm) depth *= 6.1f;
  OrthoCamera camera;
  camera.width = 128;
  camera.height = 101;
  camera.camera_from_ortho.rotation = rotationFromVector({0.2, -0.12, 0.06});
  // One among the points, so that some lie behind the camera.
  for (const double z : {200.0, 600.0}) {
    camera.camera_from_ortho.translation_mm = {0.0, 0.0, z};
    for (const double pixel_mm : {4.0, 1.1, 0.4, 0.05}) {
      camera.pixel_mm = pixel_mm;
      const Image<float> expected = host::resample(image, {}, camera);
      EXPECT_EQ(splatted(image, camera, 1), expected) << z << ", " << pixel_mm;
      EXPECT_EQ(splatted(image, camera, 2), expected) << z << ", " << pixel_mm;
    }
  }
}

using Labels = std::vector<std::atomic<int>>;

/// The three kernels of the pixel grouping, each with `threads` threads that share its pixels.
Image<std::int32_t> groupedBy(int threads, const Image<float>& range, const Image<float>& edges) {
  const int width = range.width();
  Labels labels(range.size());
  const std::vector<int> order = shuffled(range.size(), 5);
  const auto forEachPixel = [&](const auto& body) {
    std::vector<std::thread> running;
    running.reserve(static_cast<std::size_t>(threads));
    for (int t = 0; t < threads; ++t) {
      running.emplace_back([&, t] {
        for (std::size_t i = static_cast<std::size_t>(t); i < order.size();
             i += static_cast<std::size_t>(threads)) {
          body(order[i] % width, order[i] / width);
        }
      });
    }
    for (std::thread& thread : running) thread.join();
  };
  const auto at = [&](int index) -> std::atomic<int>& {
    return labels[static_cast<std::size_t>(index)];
  };
  const auto label = [&](int index) { return at(index).load(); };
  const auto lower = [&](int index, int value) {
    int before = at(index).load();
    while (value < before && !at(index).compare_exchange_weak(before, value)) {
    }
    return before;
  };
  const auto inside = [&](int x, int y) {
    return range.at(x, y) != 0.0f && edges.at(x, y) == 0.0f;
  };
  forEachPixel([&](int x, int y) { at(y * width + x) = cuda::firstLabel(x, y, width, inside); });
  forEachPixel([&](int x, int y) { cuda::joinNeighbours(x, y, width, label, lower); });
  Image<std::int32_t> result(width, range.height());
  forEachPixel([&](int x, int y) {
    const int index = y * width + x;
    result.at(x, y) = label(index) == kNoPatch ? kNoPatch : cuda::rootOf(index, label);
  });
  return result;
}

TEST(ImageBodyTest, PatchesAreTheHostsWhateverTheOrder) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host::edges(scene.range_px, kThresholdPx);
    const Image<std::int32_t> expected = host::patches(scene.range_px, edges);
    EXPECT_EQ(groupedBy(1, scene.range_px, edges), expected) << scene.name;
    EXPECT_EQ(groupedBy(4, scene.range_px, edges), expected) << scene.name << ", 4 threads";
  }
}

TEST(ImageBodyTest, PatchesReachAcrossRuns) {
  const Image<float> no_edges(100, 70, 0.0f);
  Image<float> comb(100, 70, 80.0f);
  for (int x = 1; x < 100; x += 2) {
    for (int y = 1; y < 70; ++y) comb.at(x, y) = 0.0f;
  }
  EXPECT_EQ(groupedBy(4, comb, no_edges), host::patches(comb, no_edges));
  std::reverse(comb.begin(), comb.end());
  EXPECT_EQ(groupedBy(4, comb, no_edges), host::patches(comb, no_edges));
}

}  // namespace
}  // namespace rangepose
