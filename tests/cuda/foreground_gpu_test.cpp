// The foreground of an image on the device against the host's.
#include <gtest/gtest.h>

#include "cuda/cuda_fixture.h"
#include "cuda/foreground_cuda.h"
#include "cuda/foreground_scene.h"

namespace rangepose {
namespace {

class ForegroundGpuTest : public test::CudaFixture {
 protected:
  void SetUp() override {
    CudaFixture::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    workspace_.emplace(nullptr, cuda::DeviceImage::Memory::kOwn);
    finder_.emplace(*workspace_);
  }
  cuda::ForegroundFinder& finder() { return *finder_; }
  cuda::Workspace& workspace() { return *workspace_; }

 private:
  std::optional<cuda::Workspace> workspace_;
  std::optional<cuda::ForegroundFinder> finder_;
};

/// One finder for all: an image must not see what another one left behind.
TEST_F(ForegroundGpuTest, IsTheHosts) {
  for (const test::ForegroundScene& scene : test::foregroundScenes()) {
    SCOPED_TRACE(scene.name);
    const Foreground expected = host::foreground(scene.image, scene.task);
    const std::unique_ptr<ResidentForeground> found = finder().find(scene.image, scene.task);
    test::expectLike(found->on_host, expected);
    const LateralExtent extent =
        finder().extent(dynamic_cast<const cuda::CudaDepth&>(*found->resident));
    const LateralExtent wanted = host::extentOf(expected.depth, expected.mask);
    EXPECT_EQ(extent.empty(), wanted.empty());
    EXPECT_EQ(extent.low, wanted.low);
    EXPECT_EQ(extent.high, wanted.high);
  }
}

/// Draws are made and memory grows between the rounds.
TEST_F(ForegroundGpuTest, RoundsOneByOneAreThoseInOne) {
  cuda::ForegroundFinder one_by_one(workspace(), 1);
  for (const test::ForegroundScene& scene : test::foregroundScenes()) {
    SCOPED_TRACE(scene.name);
    test::expectLike(one_by_one.find(scene.image, scene.task)->on_host,
                     host::foreground(scene.image, scene.task));
  }
}

TEST_F(ForegroundGpuTest, SameAnswerTwice) {
  const test::ForegroundScene scene = test::foregroundScenes()[3];
  const auto first = finder().find(scene.image, scene.task);
  const auto second = finder().find(scene.image, scene.task);
  EXPECT_EQ(first->on_host.noise_mm, second->on_host.noise_mm);
  ASSERT_EQ(first->on_host.background.size(), second->on_host.background.size());
  for (std::size_t i = 0; i < first->on_host.background.size(); ++i)
    EXPECT_EQ(first->on_host.background[i].offset_mm, second->on_host.background[i].offset_mm);
}

/// The comparisons above must be able to fail.
TEST_F(ForegroundGpuTest, AnotherToleranceIsNoticed) {
  const test::ForegroundScene scene = test::foregroundScenes().front();
  ForegroundTask other = scene.task;
  other.thin_mm *= 1.5;
  const auto found = finder().find(scene.image, other);
  EXPECT_NE(found->on_host.mask, host::foreground(scene.image, scene.task).mask);
}

}  // namespace
}  // namespace rangepose
