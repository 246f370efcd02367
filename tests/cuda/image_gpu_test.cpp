// The kernels of the image stages against the host: bit for bit.
#include <gtest/gtest.h>

#include "cuda/channels.h"
#include "cuda/cuda_fixture.h"
#include "stages/channels_host.h"
#include "stages/resample_host.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::awkwardScenes;
using test::RangeScene;
using ImageGpuTest = test::CudaFixture;

constexpr float kThresholdPx = 2.56f;

TEST_F(ImageGpuTest, MedianIsBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    const cuda::Array range = toDevice(scene.range_px);
    const cuda::Array result = poisoned(range.width(), range.height());
    cuda::median(range.view(), result.view(), stream());
    EXPECT_EQ(toHost<float>(result), host::median(scene.range_px)) << scene.name;
  }
}

TEST_F(ImageGpuTest, EdgesAreBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    const cuda::Array range = toDevice(scene.range_px);
    const cuda::Array result = poisoned(range.width(), range.height());
    for (const float threshold : {0.5f, kThresholdPx, 20.0f}) {
      cuda::edges(range.view(), threshold, result.view(), stream());
      EXPECT_EQ(toHost<float>(result), host::edges(scene.range_px, threshold)) << scene.name;
    }
  }
}

TEST_F(ImageGpuTest, DistancesInTilesAndInPassesAreBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> host_edges = host::edges(scene.range_px, kThresholdPx);
    const cuda::Array range = toDevice(scene.range_px);
    const cuda::Array edges = toDevice(host_edges);
    const cuda::Array even(cuda::Element::kFloat4, range.width(), range.height());
    const cuda::Array odd(cuda::Element::kFloat4, range.width(), range.height());
    const cuda::EdtScratch scratch{even.view(), odd.view()};
    // 20 passes do not fit into a tile.
    for (const int passes : {1, 7, 15, 16, 20}) {
      const cuda::Array result = poisoned(range.width(), range.height());
      cuda::distance(range.view(), edges.view(), passes, scratch, result.view(), stream());
      EXPECT_EQ(toHost<float>(result), host::distance(scene.range_px, host_edges, passes))
          << scene.name << ", passes " << passes;
      const cuda::ImageView last =
          cuda::distanceTexels(range.view(), edges.view(), passes, scratch, stream());
      EXPECT_EQ(toHost<EdtTexel>(last.texture == even.view().texture ? even : odd),
                host::distanceTexels(scene.range_px, host_edges, passes))
          << scene.name << ", passes " << passes;
    }
  }
}

TEST_F(ImageGpuTest, PatchesAreBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    for (const float threshold : {kThresholdPx, 1.0e6f}) {
      const Image<float> host_edges = host::edges(scene.range_px, threshold);
      const cuda::Array range = toDevice(scene.range_px);
      const cuda::Array edges = toDevice(host_edges);
      const cuda::Buffer<std::int32_t> labels =
          toDevice(std::vector<std::int32_t>(scene.range_px.size(), -777));
      cuda::patches(range.view(), edges.view(), labels.data(), stream());
      const Image<std::int32_t> expected = host::patches(scene.range_px, host_edges);
      EXPECT_EQ(labels.download(labels.size(), stream()),
                std::vector<std::int32_t>(expected.begin(), expected.end()))
          << scene.name;
    }
  }
}

DepthImage depthImage(bool orthographic, unsigned seed) {
  DepthImage image;
  image.camera.width = 97;
  image.camera.height = 71;
  image.camera.fx = 571.3;
  image.camera.fy = 568.9;
  image.camera.cx = 48.2;
  image.camera.cy = 36.2;
  image.camera.orthographic = orthographic;
  image.camera.pixel_size_mm = 1.37;
  image.depth_mm = test::randomBlobs(97, 71, seed);
  for (float& depth : image.depth_mm) depth *= 6.1f;
  return image;
}

TEST_F(ImageGpuTest, ResamplingIsBitExact) {
  Image<std::uint8_t> keep(97, 71, 1);
  for (std::size_t i = 0; i < keep.size(); i += 3) keep.data()[i] = 0;
  const cuda::Buffer<std::uint8_t> mask =
      toDevice(std::vector<std::uint8_t>(keep.begin(), keep.end()));
  const cuda::Buffer<unsigned> scratch(128 * 101);
  for (const bool orthographic : {false, true}) {
    const DepthImage image = depthImage(orthographic, 3);
    const cuda::Buffer<float> depth =
        toDevice(std::vector<float>(image.depth_mm.begin(), image.depth_mm.end()));
    OrthoCamera camera;
    camera.width = 128;
    camera.height = 101;
    camera.camera_from_ortho.rotation = rotationFromVector({0.2, -0.12, 0.06});
    camera.camera_from_ortho.translation_mm = {0.0, 0.0, 500.0};
    for (const double pixel_mm : {4.0, 1.1, 0.4, 0.05}) {
      camera.pixel_mm = pixel_mm;
      const ResampleSetup setup = resampleSetup(image.camera, camera);
      for (const PixelBox region : {PixelBox{0, 0, 97, 71}, PixelBox{13, 9, 80, 60}}) {
        const cuda::Array range = poisoned(128, 101);
        const cuda::DepthPixels all{depth.data(), nullptr, 97, 71};
        cuda::resample(all, setup, region, scratch.data(), range.view(), stream());
        EXPECT_EQ(toHost<float>(range), host::resample(image, {}, camera, region));
        const cuda::DepthPixels kept{depth.data(), mask.data(), 97, 71};
        cuda::resample(kept, setup, region, scratch.data(), range.view(), stream());
        EXPECT_EQ(toHost<float>(range), host::resample(image, keep, camera, region));
      }
    }
  }
}

/// The comparisons above must be able to fail.
TEST_F(ImageGpuTest, AnotherThresholdIsNoticed) {
  const Image<float> scene = awkwardScenes().front().range_px;
  const cuda::Array range = toDevice(scene);
  const cuda::Array result = poisoned(range.width(), range.height());
  cuda::edges(range.view(), 1.5f * kThresholdPx, result.view(), stream());
  EXPECT_NE(toHost<float>(result), host::edges(scene, kThresholdPx));
}

}  // namespace
}  // namespace rangepose
