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
    const auto expected = host().foreground(scene.image, scene.task);
    const auto actual = subject().foreground(scene.image, scene.task);
    EXPECT_EQ(actual->on_host.mask, expected->on_host.mask);
    EXPECT_EQ(actual->on_host.depth.depth_mm, expected->on_host.depth.depth_mm);
    EXPECT_EQ(actual->on_host.background.size(), expected->on_host.background.size());
    const LateralExtent wanted = host().extent(*expected->resident);
    const LateralExtent extent = subject().extent(*actual->resident);
    EXPECT_EQ(extent.low, wanted.low);
    EXPECT_EQ(extent.high, wanted.high);
    // What a path found and what is uploaded to it are the same.
    const auto uploaded =
        subject().uploadDepth(expected->on_host.depth, expected->on_host.mask);
    EXPECT_EQ(subject().extent(*uploaded).low, wanted.low);
  }
}

}  // namespace
}  // namespace rangepose
