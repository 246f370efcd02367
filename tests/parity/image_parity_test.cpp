// Median, edges, distance transform and patches: the same pixels on every path.
#include <gtest/gtest.h>

#include "parity/parity_fixture.h"
#include "support/range_scenes.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

class ImageParity : public test::Parity {};
RP_PARITY_SUBJECTS(ImageParity);
using test::awkwardScenes;
using test::differences;
using test::RangeScene;

constexpr float kThresholdPx = 2.56f;

TEST_P(ImageParity, MedianIsBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    EXPECT_EQ(
        differences(subject().probe->median(scene.range_px), host().probe->median(scene.range_px)),
        0)
        << scene.name;
  }
}

TEST_P(ImageParity, EdgesAreBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    for (const float threshold : {0.5f, kThresholdPx, 20.0f}) {
      EXPECT_EQ(differences(subject().probe->edges(scene.range_px, threshold),
                            host().probe->edges(scene.range_px, threshold)),
                0)
          << scene.name << ", threshold " << threshold;
    }
  }
}

TEST_P(ImageParity, SitesAndSquaredDistancesAreBitExact) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host().probe->edges(scene.range_px, kThresholdPx);
    for (const int passes : {1, 7, 15}) {
      EXPECT_EQ(differences(subject().probe->distanceTexels(scene.range_px, edges, passes),
                            host().probe->distanceTexels(scene.range_px, edges, passes)),
                0)
          << scene.name << ", passes " << passes;
    }
  }
}

TEST_P(ImageParity, OneEdgePixelReachesAsFarAsThePasses) {
  Image<float> edges(64, 64, 0.0f);
  edges.at(0, 63) = 1.0f;
  const Image<float> range(64, 64, 90.0f);
  const Image<EdtTexel> texels = subject().probe->distanceTexels(range, edges, 7);
  EXPECT_EQ(differences(texels, host().probe->distanceTexels(range, edges, 7)), 0);
  EXPECT_EQ(texels.at(7, 63).found, 1.0f);
  EXPECT_EQ(texels.at(5, 58).found, 1.0f);
  EXPECT_EQ(texels.at(8, 63).found, 0.0f);
}

TEST_P(ImageParity, DistancesAgreeToTheRootsRounding) {
  const std::int64_t allowed = deviceUlps();
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host().probe->edges(scene.range_px, kThresholdPx);
    const Image<float> expected = host().probe->distance(scene.range_px, edges, 7);
    const Image<float> actual = subject().probe->distance(scene.range_px, edges, 7);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_LE(test::ulpsBetween(actual.data()[i], expected.data()[i]), allowed)
          << scene.name << ", pixel " << i;
    }
  }
}

TEST_P(ImageParity, PatchLabelsAreEqual) {
  for (const RangeScene& scene : awkwardScenes()) {
    const Image<float> edges = host().probe->edges(scene.range_px, kThresholdPx);
    EXPECT_EQ(differences(subject().probe->patches(scene.range_px, edges),
                          host().probe->patches(scene.range_px, edges)),
              0)
        << scene.name;
    const Image<float> none(scene.range_px.width(), scene.range_px.height(), 0.0f);
    EXPECT_EQ(differences(subject().probe->patches(scene.range_px, none),
                          host().probe->patches(scene.range_px, none)),
              0)
        << scene.name << " without edges";
  }
}

TEST_P(ImageParity, UploadedScenesComeBackAndGiveTheSamePatches) {
  SceneChannels channels;
  channels.range_px = test::randomBlobs(64, 48, 8);
  channels.edges = host().probe->edges(channels.range_px, kThresholdPx);
  channels.distance_px = host().probe->distance(channels.range_px, channels.edges, 7);
  channels.camera.width = 64;
  channels.camera.height = 48;
  const std::unique_ptr<ResidentScene> scene = subject().scenes->upload(channels);
  const SceneChannels back = scene->download();
  EXPECT_EQ(back.range_px, channels.range_px);
  EXPECT_EQ(back.edges, channels.edges);
  EXPECT_EQ(back.distance_px, channels.distance_px);
  EXPECT_EQ(scene->camera().width, 64);
  EXPECT_EQ(subject().scenes->patches(*scene),
            host().probe->patches(channels.range_px, channels.edges));
}

/// Kernels have sabotage tests of their own.
class ShaderParity : public test::Parity {};
INSTANTIATE_TEST_SUITE_P(,
                         ShaderParity,
                         testing::Values("glsl", "glsl_on_desktop_gl"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(ShaderParity, AFaultInAShaderIsNoticed) {
  const std::unique_ptr<StageSet> faulty = gles::makeGlesStages(context(), {{"RP_FAULT", "1"}});
  const Image<float> range = test::randomBlobs(64, 64, 2);
  const Image<float> edges = host().probe->edges(range, kThresholdPx);
  const Image<EdtTexel> expected = host().probe->distanceTexels(range, edges, 7);
  EXPECT_GT(differences(faulty->probe->distanceTexels(range, edges, 7), expected), 0);
  EXPECT_EQ(differences(subject().probe->distanceTexels(range, edges, 7), expected), 0);
}

}  // namespace
}  // namespace rangepose
