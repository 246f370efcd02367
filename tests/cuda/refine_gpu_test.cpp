// Alignment and verdict of many poses on the device against the host's functions.
#include <gtest/gtest.h>

#include "cuda/cuda_fixture.h"
#include "cuda/refine.h"
#include "cuda/refine_scene.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

/// The device's sine and cosine may round another way than the host's [mm].
constexpr double kDeviceMm = 10.0 * test::kAlignedMm;

class RefineGpuTest : public test::CudaFixture {
 protected:
  cuda::ResidentImage resident(const DepthImage& image) {
    depth_ = toDevice(std::vector<float>(image.depth_mm.begin(), image.depth_mm.end()));
    return {image.camera, depth_.data()};
  }

  std::vector<IcpResult> align(const test::RefineScene& scene,
                               const std::vector<cuda::IcpTask>& tasks,
                               const std::vector<SurfacePoint>& points,
                               int most) {
    const cuda::ResidentImage image = resident(scene.depth);
    const cuda::Buffer<cuda::IcpTask> on_device = toDevice(tasks);
    const cuda::Buffer<SurfacePoint> all = toDevice(points);
    const cuda::Buffer<IcpResult> results(tasks.size());
    cuda::align(image,
                on_device.data(),
                static_cast<int>(tasks.size()),
                most,
                all.data(),
                results.data(),
                stream());
    return results.download(results.size(), stream());
  }

 private:
  cuda::Buffer<float> depth_;
};

IcpResult onHost(const test::RefineScene& scene,
                 const std::vector<SurfacePoint>& points,
                 const IcpOptions& options) {
  return host::icp(points,
                   scene.depth.camera,
                   scene.depth.depth_mm,
                   scene.rough,
                   scene.object.center_mm,
                   scene.object.radius_mm,
                   options);
}

TEST_F(RefineGpuTest, ManyPosesAreAlignedAsOnTheHost) {
  for (const bool orthographic : {false, true}) {
    test::RefineScene scene(16, orthographic);
    scene.show(5);
    for (const int count : {40, 300}) {
      std::vector<cuda::IcpTask> tasks;
      std::vector<SurfacePoint> all;
      std::vector<IcpResult> expected;
      int most = 0;
      for (int view = 0; view < 16; ++view) {
        const std::vector<SurfacePoint> points = pointsOfView(scene.object, view, count);
        IcpOptions options;
        options.iterations = 4 + view % 5;
        tasks.push_back(scene.icpTask(points, options));
        tasks.back().first_point = static_cast<int>(all.size());
        all.insert(all.end(), points.begin(), points.end());
        expected.push_back(onHost(scene, points, options));
        most = std::max(most, static_cast<int>(points.size()));
      }
      const std::vector<IcpResult> actual = align(scene, tasks, all, most);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_LT(test::farthestCorner(
                      scene.object, actual[i].camera_from_object, expected[i].camera_from_object),
                  kDeviceMm)
            << "task " << i << ", " << count << " points";
        EXPECT_EQ(actual[i].iterations, expected[i].iterations);
        EXPECT_EQ(actual[i].paired, expected[i].paired);
        EXPECT_NEAR(actual[i].rms_mm, expected[i].rms_mm, kDeviceMm);
      }
      const std::vector<IcpResult> again = align(scene, tasks, all, most);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(again[i].camera_from_object.rotation, actual[i].camera_from_object.rotation);
        EXPECT_EQ(again[i].camera_from_object.translation_mm,
                  actual[i].camera_from_object.translation_mm);
      }
    }
  }
}

/// The comparison above must be able to fail.
TEST_F(RefineGpuTest, AnotherReachIsNoticed) {
  test::RefineScene scene(1, false);
  const std::vector<SurfacePoint> points = pointsOfView(scene.object, 0, 300);
  IcpOptions wrong;
  wrong.first_reach_mm *= 0.5;
  const std::vector<IcpResult> actual =
      align(scene, {scene.icpTask(points, wrong)}, points, static_cast<int>(points.size()));
  EXPECT_GT(
      test::farthestCorner(
          scene.object, actual[0].camera_from_object, onHost(scene, points, {}).camera_from_object),
      kDeviceMm);
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
}

TEST_F(RefineGpuTest, VerdictsOnPointsAreTheHosts) {
  for (const bool orthographic : {false, true}) {
    test::RefineScene scene(8, orthographic);
    scene.show(2);
    std::vector<cuda::PointsTask> tasks;
    std::vector<SurfacePoint> all;
    std::vector<CheckResult> expected;
    for (int view = 0; view < 8; ++view) {
      const std::vector<SurfacePoint> points = pointsOfView(scene.object, view, 200);
      cuda::PointsTask task;
      task.first_point = static_cast<int>(all.size());
      task.point_count = static_cast<int>(points.size());
      task.camera_from_object = view % 2 == 0 ? scene.truth : scene.rough;
      task.visible_mm2 = 1234.5;
      tasks.push_back(task);
      all.insert(all.end(), points.begin(), points.end());
      expected.push_back(
          host::checkPoints(points, task.camera_from_object, 1234.5, scene.depth, task.options));
    }
    const cuda::ResidentImage image = resident(scene.depth);
    const cuda::Buffer<cuda::PointsTask> on_device = toDevice(tasks);
    const cuda::Buffer<SurfacePoint> points = toDevice(all);
    const cuda::Buffer<CheckResult> results(tasks.size());
    cuda::judgePoints(image, on_device.data(), 8, points.data(), results.data(), stream());
    const std::vector<CheckResult> actual = results.download(8, stream());
    for (std::size_t i = 0; i < 8; ++i) expectSame(actual[i], expected[i], test::kPointVerdict);
  }
}

TEST_F(RefineGpuTest, VerdictsOnSurfacesAreTheHosts) {
  for (const bool orthographic : {false, true}) {
    test::RefineScene scene(8, orthographic);
    scene.show(2);
    const Camera& camera = scene.depth.camera;
    std::vector<cuda::Array> surfaces;
    std::vector<cuda::SurfaceTask> tasks;
    std::vector<CheckResult> expected;
    for (int i = 0; i < 6; ++i) {
      Pose pose = scene.truth;
      pose.translation_mm.x -= 25.0 * i;  // the last ones are cut by the border of the image
      const SurfaceWindow window = wholeWindowAround(
          camera, pose * scene.object.center_mm, scene.object.radius_mm, i % 2 == 0 ? 112 : 40);
      if (window.width == 0) continue;
      const Image<SurfaceTexel> surface =
          host::renderSurface(scene.object.mesh, camera, pose, window);
      surfaces.push_back(toDevice(surface));
      tasks.push_back({surfaces.back().view(), window, scene.sphereAt(pose), {}});
      expected.push_back(host::check(surface, window, scene.depth, scene.sphereAt(pose), {}));
    }
    ASSERT_GE(tasks.size(), 4U);
    const cuda::ResidentImage image = resident(scene.depth);
    const cuda::Buffer<cuda::SurfaceTask> on_device = toDevice(tasks);
    const cuda::Buffer<CheckResult> results(tasks.size());
    cuda::judgeSurfaces(
        image, on_device.data(), static_cast<int>(tasks.size()), results.data(), stream());
    const std::vector<CheckResult> actual = results.download(tasks.size(), stream());
    for (std::size_t i = 0; i < actual.size(); ++i) expectSame(actual[i], expected[i]);
  }
}

}  // namespace
}  // namespace rangepose
