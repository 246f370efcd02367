// The bodies of alignment and verdict, run on the host, against the host's functions.
#include <gtest/gtest.h>

#include "cuda/refine_scene.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

template <int kThreads>
IcpResult alignedByBlock(const test::RefineScene& scene,
                         const std::vector<SurfacePoint>& points,
                         const IcpOptions& options) {
  const auto read = [&](bool where, int u, int v) {
    return where ? scene.depth.depth_mm.at(u, v) : 0.0f;
  };
  cuda::IcpShared shared{};
  cuda::HostBlock<kThreads> block;
  IcpResult answer;
  cuda::alignPose(block,
                  shared,
                  scene.icpTask(points, options),
                  scene.depth.camera,
                  read,
                  points.data(),
                  answer);
  return answer;
}

class RefineBodyTest : public testing::TestWithParam<bool> {};

TEST_P(RefineBodyTest, AlignmentIsTheHosts) {
  test::RefineScene scene(12, GetParam());
  for (int view = 0; view < 12; ++view) {
    scene.show(view);
    for (const int count : {40, 300}) {
      const std::vector<SurfacePoint> points = pointsOfView(scene.object, view, count);
      IcpOptions options;
      options.search_steps = count == 40 ? 1 : 2;
      const IcpResult expected = host::icp(points,
                                           scene.depth.camera,
                                           scene.depth.depth_mm,
                                           scene.rough,
                                           scene.object.center_mm,
                                           scene.object.radius_mm,
                                           options);
      const IcpResult actual = alignedByBlock<64>(scene, points, options);
      EXPECT_LT(test::farthestCorner(
                    scene.object, actual.camera_from_object, expected.camera_from_object),
                test::kAlignedMm)
          << "view " << view << ", " << count << " points";
      EXPECT_EQ(actual.iterations, expected.iterations);
      EXPECT_EQ(actual.paired, expected.paired);
      EXPECT_NEAR(actual.rms_mm, expected.rms_mm, test::kAlignedMm);
      EXPECT_GT(test::farthestCorner(scene.object, actual.camera_from_object, scene.rough), 1.0)
          << "nothing moved";
    }
  }
}

TEST_P(RefineBodyTest, RimsAreTheHosts) {
  test::RefineScene scene(4, GetParam());
  for (int view = 0; view < 4; ++view) {
    scene.show(view);
    const Camera& camera = scene.depth.camera;
    const auto [window, surface] = scene.seenAt(scene.truth);
    std::vector<SurfacePoint> points = pointsOfSurface(surface, camera, window, scene.truth, 300);
    const std::vector<SurfacePoint> rim = rimOfSurface(surface, camera, window, scene.truth, 300);
    ASSERT_GT(rim.size(), 10U);
    points.insert(points.end(), rim.begin(), rim.end());
    IcpOptions options;
    const auto byHost = [&] {
      return host::icp(points,
                       camera,
                       scene.depth.depth_mm,
                       scene.rough,
                       scene.object.center_mm,
                       scene.object.radius_mm,
                       options);
    };
    const IcpResult without = byHost();
    options.rim_reach_mm = 6.0;
    const IcpResult expected = byHost();
    const IcpResult actual = alignedByBlock<64>(scene, points, options);
    EXPECT_LT(
        test::farthestCorner(scene.object, actual.camera_from_object, expected.camera_from_object),
        test::kAlignedMm)
        << "view " << view;
    EXPECT_EQ(actual.paired, expected.paired);
    EXPECT_GT(
        test::farthestCorner(scene.object, without.camera_from_object, expected.camera_from_object),
        10.0 * test::kAlignedMm)
        << "rims change nothing";
  }
}

TEST_P(RefineBodyTest, TheNumberOfThreadsMovesNothingMuch) {
  test::RefineScene scene(1, GetParam());
  const std::vector<SurfacePoint> points = pointsOfView(scene.object, 0, 300);
  const IcpResult few = alignedByBlock<64>(scene, points, {});
  const IcpResult many = alignedByBlock<256>(scene, points, {});
  EXPECT_LT(test::farthestCorner(scene.object, few.camera_from_object, many.camera_from_object),
            test::kAlignedMm);
}

TEST_P(RefineBodyTest, TooFewPointsLeaveThePoseAlone) {
  test::RefineScene scene(1, GetParam());
  std::vector<SurfacePoint> points = pointsOfView(scene.object, 0, 300);
  for (const std::size_t count : {std::size_t{0}, std::size_t{5}}) {
    points.resize(count);
    const IcpResult result = alignedByBlock<64>(scene, points, {});
    EXPECT_EQ(result.camera_from_object.translation_mm, scene.rough.translation_mm);
    EXPECT_EQ(result.iterations, 1);
    EXPECT_EQ(result.rms_mm, 0.0);
  }
}

void expectSame(const CheckResult& actual,
                const CheckResult& expected,
                double tolerance = test::kVerdict) {
  EXPECT_NEAR(actual.explained, expected.explained, tolerance);
  EXPECT_EQ(actual.contradicted, expected.contradicted);
  EXPECT_EQ(actual.hidden, expected.hidden);
  EXPECT_EQ(actual.buried, expected.buried);
  EXPECT_EQ(actual.missing, expected.missing);
  EXPECT_NEAR(actual.weak, expected.weak, tolerance);
  EXPECT_EQ(actual.outline, expected.outline);
  EXPECT_NEAR(actual.residual_mm, expected.residual_mm, tolerance);
  EXPECT_NEAR(actual.explained_mm2, expected.explained_mm2, tolerance * 1.0e4);
  EXPECT_EQ(actual.pixels, expected.pixels);
  EXPECT_NEAR(actual.score, expected.score, tolerance);
  EXPECT_EQ(actual.seen_through, expected.seen_through);
  EXPECT_EQ(actual.inner_px, expected.inner_px);
  EXPECT_NEAR(actual.relief, expected.relief, 1e-6);
  EXPECT_NEAR(actual.whole_relief, expected.whole_relief, 1e-6);
}

TEST_P(RefineBodyTest, VerdictOnPointsIsTheHosts) {
  test::RefineScene scene(8, GetParam());
  const auto read = [&](bool where, int u, int v) {
    return where ? scene.depth.depth_mm.at(u, v) : 0.0f;
  };
  cuda::HostBlock<64> block;
  double explained = 0.0;
  for (int view = 0; view < 8; ++view) {
    scene.show(view);
    const std::vector<SurfacePoint> points = pointsAndRimOfView(scene.object, view, 200);
    for (const Pose& pose : {scene.truth, scene.rough}) {
      cuda::PointsTask task;
      task.point_count = static_cast<int>(points.size());
      task.camera_from_object = pose;
      task.visible_mm2 = 1234.5;
      CheckResult actual;
      cuda::judgeTaskPoints(block, task, scene.depth.camera, read, points.data(), actual);
      expectSame(actual,
                 host::checkPoints(points, pose, 1234.5, scene.depth, task.options),
                 test::kPointVerdict);
      explained += actual.explained;
    }
  }
  EXPECT_GT(explained, 2.0) << "nothing was there to explain";
}

TEST_P(RefineBodyTest, VerdictOnSurfacesIsTheHosts) {
  test::RefineScene scene(8, GetParam());
  const auto read = [&](bool where, int u, int v) {
    return where ? scene.depth.depth_mm.at(u, v) : 0.0f;
  };
  cuda::HostBlock<64> block;
  double outline = 0.0;
  for (int view = 0; view < 8; ++view) {
    scene.show(view);
    const Camera& camera = scene.depth.camera;
    Pose pose = scene.truth;
    if (view % 2 == 1) pose.translation_mm.x -= 60.0;  // cut by the border of the image
    for (const int most : {40, 112}) {
      const SurfaceWindow window =
          wholeWindowAround(camera, pose * scene.object.center_mm, scene.object.radius_mm, most);
      const Image<SurfaceTexel> surface =
          host::renderSurface(scene.object.mesh, camera, pose, window);
      CheckResult actual;
      cuda::judgeRendered(
          block,
          [&](int x, int y) { return surface.at(x, y); },
          window,
          scene.sphereAt(pose),
          CheckOptions{},
          camera,
          read,
          actual);
      expectSame(actual, host::check(surface, window, scene.depth, scene.sphereAt(pose), {}));
      outline += actual.outline;
    }
  }
  EXPECT_GT(outline, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Cameras, RefineBodyTest, testing::Bool(), [](const auto& with) {
  return with.param ? "Orthographic" : "Perspective";
});

}  // namespace
}  // namespace rangepose
