// The body that picks points of a rendered surface, run on the host, against the host's function.
#include "cuda/surface_points_body.h"

#include <gtest/gtest.h>

#include <vector>

#include "cuda/refine_scene.h"

namespace rangepose {
namespace {

template <int kThreads>
std::vector<SurfacePoint> pickedByBlock(const Image<SurfaceTexel>& surface,
                                        const SurfaceWindow& window,
                                        const test::RefineScene& scene,
                                        int max_points,
                                        bool with_rim) {
  const auto read = [&](int x, int y) { return surface.at(x, y); };
  cuda::PickShared<kThreads> shared{};
  cuda::HostBlock<kThreads> block;
  std::vector<SurfacePoint> points(2 * surface.size() + 1);
  int count = -1;
  cuda::pickPoints(block,
                   shared,
                   read,
                   window,
                   scene.depth.camera,
                   scene.rough,
                   max_points,
                   with_rim,
                   points.data(),
                   count);
  points.resize(static_cast<std::size_t>(count));
  return points;
}

void expectSame(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position_mm, b[i].position_mm) << i;
    EXPECT_EQ(a[i].normal, b[i].normal) << i;
    EXPECT_EQ(a[i].rim, b[i].rim) << i;
  }
}

class SurfacePointsBodyTest : public testing::TestWithParam<bool> {};

TEST_P(SurfacePointsBodyTest, PointsAndTheirOrderAreTheHosts) {
  test::RefineScene scene(3, GetParam());
  for (int view = 0; view < 3; ++view) {
    scene.show(view);
    const Camera& camera = scene.depth.camera;
    const auto [window, surface] = scene.seenAt(scene.rough);
    for (const int most : {1, 7, 60, 900, 100000}) {
      std::vector<SurfacePoint> expected =
          pointsOfSurface(surface, camera, window, scene.rough, most);
      expectSame(pickedByBlock<64>(surface, window, scene, most, false), expected);
      expectSame(pickedByBlock<256>(surface, window, scene, most, false), expected);
      const std::vector<SurfacePoint> rim =
          rimOfSurface(surface, camera, window, scene.rough, most);
      if (most >= 60) {
        EXPECT_FALSE(rim.empty());
      }
      expected.insert(expected.end(), rim.begin(), rim.end());
      expectSame(pickedByBlock<64>(surface, window, scene, most, true), expected);
      expectSame(pickedByBlock<256>(surface, window, scene, most, true), expected);
    }
  }
}

TEST_P(SurfacePointsBodyTest, NothingSeenGivesNoPoint) {
  const test::RefineScene scene(1, GetParam());
  const SurfaceWindow window{0, 0, 20, 11, 1};
  const Image<SurfaceTexel> empty(20, 11, SurfaceTexel(0.0f));
  EXPECT_TRUE(pickedByBlock<64>(empty, window, scene, 100, true).empty());
  const SurfaceWindow none{0, 0, 0, 0, 1};
  EXPECT_TRUE(pickedByBlock<64>(Image<SurfaceTexel>(), none, scene, 100, true).empty());
}

INSTANTIATE_TEST_SUITE_P(Cameras, SurfacePointsBodyTest, testing::Bool(), [](const auto& with) {
  return with.param ? "Orthographic" : "Pinhole";
});

}  // namespace
}  // namespace rangepose
