// Depth image to orthographic range image, and the chain from there to the channels.
#include <gtest/gtest.h>

#include "parity/parity_fixture.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

class ResampleParity : public test::Parity {};
RP_PARITY_SUBJECTS(ResampleParity);
using test::differences;

DepthImage depthImage(int width, int height, unsigned seed, bool orthographic) {
  DepthImage image;
  image.camera.width = width;
  image.camera.height = height;
  image.camera.fx = 571.3;
  image.camera.fy = 568.9;
  image.camera.cx = 0.5 * width - 0.3;
  image.camera.cy = 0.5 * height + 0.7;
  image.camera.orthographic = orthographic;
  image.camera.pixel_size_mm = 1.37;
  image.depth_mm = test::randomBlobs(width, height, seed);
  for (float& depth : image.depth_mm) depth *= 6.1f;
  return image;
}

/// A camera that looks along the middle of the image, a little turned.
OrthoCamera orthoCamera(
    const DepthImage& image, int width, int height, double pixel_mm, double turn) {
  OrthoCamera camera;
  camera.width = width;
  camera.height = height;
  camera.pixel_mm = pixel_mm;
  const Camera& sensor = image.camera;
  camera.camera_from_ortho.rotation = rotationFromVector({turn, -0.6 * turn, 0.3 * turn});
  camera.camera_from_ortho.translation_mm =
      sensor.unproject(0.5 * sensor.width, 0.5 * sensor.height, 600.0) -
      camera.camera_from_ortho.rotation * glm::dvec3(0.0, 0.0, 400.0);
  return camera;
}

TEST_P(ResampleParity, RangeIsBitExact) {
  int measured = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    for (const bool orthographic : {false, true}) {
      const DepthImage image = depthImage(97, 71, seed, orthographic);
      // Coarse to fine: many measurements in a pixel, then many pixels for a measurement.
      for (const double pixel_mm : {4.0, 1.1, 0.4, 0.05}) {
        const OrthoCamera camera = orthoCamera(image, 128, 101, pixel_mm, 0.11 * seed);
        const Image<float> expected = host().probe->resample(image, {}, camera);
        EXPECT_EQ(differences(subject().probe->resample(image, {}, camera), expected), 0)
            << "seed " << seed << ", orthographic " << orthographic << ", pixel " << pixel_mm;
        for (const float range : expected) measured += range != 0.0f ? 1 : 0;
      }
    }
  }
  EXPECT_GT(measured, 20000) << "the scenes must fill the images";
}

TEST_P(ResampleParity, MaskedPixelsAreLeftOut) {
  const DepthImage image = depthImage(64, 48, 7, false);
  const OrthoCamera camera = orthoCamera(image, 64, 64, 1.0, 0.2);
  Image<std::uint8_t> keep(64, 48, 0);
  for (int y = 10; y < 40; ++y) {
    for (int x = 0; x < 64; ++x) keep.at(x, y) = static_cast<std::uint8_t>((x + y) % 3);
  }
  const Image<float> expected = host().probe->resample(image, keep, camera);
  EXPECT_EQ(differences(subject().probe->resample(image, keep, camera), expected), 0);
  EXPECT_GT(differences(expected, host().probe->resample(image, {}, camera)), 0);
  const Image<std::uint8_t> nothing(64, 48, 0);
  EXPECT_EQ(subject().probe->resample(image, nothing, camera), Image<float>(64, 64, 0.0f));
}

TEST_P(ResampleParity, PointsBehindTheCameraAreLeftOut) {
  const DepthImage image = depthImage(64, 48, 3, false);
  OrthoCamera camera = orthoCamera(image, 64, 64, 1.0, 0.0);
  camera.camera_from_ortho.translation_mm.z += 400.0;  // among the points
  const Image<float> expected = host().probe->resample(image, {}, camera);
  EXPECT_EQ(differences(subject().probe->resample(image, {}, camera), expected), 0);
}

void expectSame(const SceneChannels& actual, const SceneChannels& expected) {
  EXPECT_EQ(differences(actual.range_px, expected.range_px), 0);
  EXPECT_EQ(differences(actual.edges, expected.edges), 0);
  ASSERT_EQ(actual.distance_px.size(), expected.distance_px.size());
  for (std::size_t i = 0; i < expected.distance_px.size(); ++i) {
    ASSERT_FLOAT_EQ(actual.distance_px.data()[i], expected.distance_px.data()[i]);
  }
}

TEST_P(ResampleParity, PreparedChannelsAreThoseOfTheHost) {
  const DepthImage image = depthImage(120, 90, 5, false);
  const OrthoCamera camera = orthoCamera(image, 128, 128, 0.9, 0.15);
  for (const PixelBox region : {PixelBox{}, PixelBox{13, 9, 101, 77}}) {
    const SceneChannels expected = test::prepared(host(), image, {}, {camera, region})->download();
    const SceneChannels actual = test::prepared(subject(), image, {}, {camera, region})->download();
    expectSame(actual, expected);
  }
}

/// A stage that does not wait must leave alone what the kernels it has queued still use: images
/// that serve again and again, and those of many sizes, which make room for each other.
TEST_P(ResampleParity, WindowsPreparedInARowAreWholeWhenTheyAreReadAfterwards) {
  constexpr int kWindows = 16;
  constexpr int kRounds = 4;
  const DepthImage image = depthImage(120, 90, 6, false);
  for (const int growth : {0, 2}) {
    std::vector<OrthoCamera> cameras;
    std::vector<SceneChannels> expected;
    cameras.reserve(kWindows);
    expected.reserve(kWindows);
    for (int i = 0; i < kWindows; ++i) {
      const int size = 64 + growth * i;
      cameras.push_back(orthoCamera(image, size, size, 0.8 + 0.05 * i, 0.02 * i));
      expected.push_back(test::prepared(host(), image, {}, {cameras.back(), {}})->download());
    }
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::unique_ptr<ResidentScene>> scenes;
      scenes.reserve(cameras.size());
      for (const OrthoCamera& camera : cameras)
        scenes.push_back(test::prepared(subject(), image, {}, {camera, {}}));
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        SCOPED_TRACE("growth " + std::to_string(growth) + ", round " + std::to_string(round) +
                     ", window " + std::to_string(i));
        expectSame(scenes[i]->download(), expected[i]);
      }
    }
  }
}

}  // namespace
}  // namespace rangepose
