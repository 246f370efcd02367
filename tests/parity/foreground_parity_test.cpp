// The foreground of an image, and from there to the extent that the scene camera is made of.
#include <gtest/gtest.h>

#include <string>

#include "cuda/foreground_scene.h"
#include "parity/parity_fixture.h"

namespace rangepose {
namespace {

/// On the glsl path it stays on the host.
class ForegroundParity : public test::Parity {};
INSTANTIATE_TEST_SUITE_P(Cuda,
                         ForegroundParity,
                         testing::Values("cuda", "cuda_gles", "cuda_gl", "cuda_copy"),
                         [](const auto& test_info) { return std::string(test_info.param); });

TEST_P(ForegroundParity, MaskPlanesAndExtentAreTheHosts) {
  for (const test::ForegroundScene& scene : test::foregroundScenes()) {
    SCOPED_TRACE(scene.name);
    const auto expected = host().foreground->find(scene.image, scene.task);
    const auto actual = subject().foreground->find(scene.image, scene.task);
    test::expectLike(actual->on_host, expected->on_host);
    const LateralExtent wanted = host().foreground->extent(*expected->resident);
    const LateralExtent extent = subject().foreground->extent(*actual->resident);
    EXPECT_EQ(extent.low, wanted.low);
    EXPECT_EQ(extent.high, wanted.high);
    // What a path found and what is uploaded to it are the same.
    const auto uploaded =
        subject().foreground->upload(expected->on_host.depth, expected->on_host.mask);
    EXPECT_EQ(subject().foreground->extent(*uploaded).low, wanted.low);
  }
}

/// No mask, and one that also keeps what was not measured.
TEST_P(ForegroundParity, ExtentIsThatOfMeasuredPixels) {
  const DepthImage image = test::foregroundScenes().front().image;
  const Image<std::uint8_t> all(image.camera.width, image.camera.height, 1);
  for (const Image<std::uint8_t>& keep : {Image<std::uint8_t>(), all}) {
    const LateralExtent wanted = host().foreground->extent(*host().foreground->upload(image, keep));
    const LateralExtent extent =
        subject().foreground->extent(*subject().foreground->upload(image, keep));
    EXPECT_FALSE(wanted.empty());
    EXPECT_EQ(extent.low, wanted.low);
    EXPECT_EQ(extent.high, wanted.high);
  }
}

}  // namespace
}  // namespace rangepose
