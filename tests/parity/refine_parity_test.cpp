// Alignment and verdict of many poses on each path against the host's.
#include <gtest/gtest.h>

#include "cuda/refine_scene.h"
#include "parity/parity_fixture.h"

namespace rangepose {
namespace {

constexpr int kViews = 6;

class RefineParity : public test::Parity {
 protected:
  void SetUp() override {
    Parity::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    const DepthImage& depth = scene_.depth;
    keep_ = Image<std::uint8_t>(depth.camera.width, depth.camera.height, 1);
    for (int y = 0; y < depth.camera.height; ++y) keep_.at(5, y) = 0;
    at_host_ = host().foreground->upload(depth, keep_);
    at_subject_ = subject().foreground->upload(depth, keep_);
    for (int view = 0; view < kViews; ++view) {
      points_.push_back(pointsAndRimOfView(scene_.object, view, 100 + 20 * view));
    }
  }
  /// The fixture's proof of work, for a path that aligns on the host.
  void TearDown() override {
    if (at_subject_ != nullptr && onGlsl())
      static_cast<void>(subject().probe->median(scene_.depth.depth_mm));
    at_subject_.reset();
    Parity::TearDown();
  }
  std::vector<RenderTask> renderTasks() const {
    std::vector<RenderTask> tasks;
    for (const Pose& pose : {scene_.rough, scene_.truth, scene_.rough}) {
      RenderTask task;
      task.mesh = &scene_.object.mesh;
      task.camera_from_object = pose;
      task.window = wholeWindowAround(scene_.depth.camera,
                                      pose * scene_.object.center_mm,
                                      scene_.object.radius_mm,
                                      tasks.size() == 2 ? 40 : 112);
      task.max_points = 300;
      task.alignment.rim_reach_mm = 3.0;
      task.center_mm = scene_.object.center_mm;
      task.radius_mm = scene_.object.radius_mm;
      tasks.push_back(task);
    }
    return tasks;
  }

  test::RefineScene scene_{kViews, false};
  Image<std::uint8_t> keep_;
  std::unique_ptr<ResidentDepth> at_host_;
  std::unique_ptr<ResidentDepth> at_subject_;
  std::vector<std::vector<SurfacePoint>> points_;
};
RP_PARITY_SUBJECTS(RefineParity);

TEST_P(RefineParity, PosesAreAlignedAlike) {
  IcpOptions options;
  options.rim_reach_mm = 5.0;
  std::vector<AlignTask> tasks;
  for (const auto& points : points_) {
    tasks.push_back(
        {&points, scene_.rough, scene_.object.center_mm, scene_.object.radius_mm, options});
  }
  const std::vector<IcpResult> expected = host().refine->align(*at_host_, tasks);
  const std::vector<IcpResult> actual = subject().refine->align(*at_subject_, tasks);
  ASSERT_EQ(actual.size(), tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_LT(test::farthestCorner(
                  scene_.object, actual[i].camera_from_object, expected[i].camera_from_object),
              test::kAlignedMm);
    EXPECT_EQ(actual[i].iterations, expected[i].iterations);
    EXPECT_EQ(actual[i].paired, expected[i].paired);
  }
}

TEST_P(RefineParity, PointsAreJudgedAlike) {
  std::vector<JudgeTask> tasks;
  for (const auto& points : points_) tasks.push_back({&points, scene_.truth, 900.0, {}});
  const std::vector<CheckResult> expected = host().refine->judge(*at_host_, tasks);
  const std::vector<CheckResult> actual = subject().refine->judge(*at_subject_, tasks);
  ASSERT_EQ(actual.size(), tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_EQ(actual[i].pixels, expected[i].pixels);
    EXPECT_NEAR(actual[i].score, expected[i].score, test::kPointVerdict);
    EXPECT_NEAR(actual[i].residual_mm, expected[i].residual_mm, test::kPointVerdict);
  }
}

/// Kept points stay on a device from call to call, among others that do not.
TEST_P(RefineParity, KeptPointsAreThoseOfTheirTask) {
  using Choice = std::vector<std::pair<std::size_t, bool>>;  // points, whether they are kept
  for (const Choice& choice : {Choice{{2, true}, {0, true}},
                               Choice{{1, false}, {0, true}, {3, true}},
                               Choice{{2, true}, {4, false}, {5, true}, {1, true}}}) {
    std::vector<JudgeTask> judged;
    std::vector<AlignTask> aligned;
    for (const auto& [at, kept] : choice) {
      const auto* points = &points_[at];
      const std::uint64_t name = kept ? at + 1 : 0;
      judged.push_back({points, scene_.truth, 900.0, {}, name});
      aligned.push_back(
          {points, scene_.rough, scene_.object.center_mm, scene_.object.radius_mm, {}, name});
    }
    const std::vector<CheckResult> expected = host().refine->judge(*at_host_, judged);
    const std::vector<CheckResult> actual = subject().refine->judge(*at_subject_, judged);
    const std::vector<IcpResult> moved = host().refine->align(*at_host_, aligned);
    const std::vector<IcpResult> also_moved = subject().refine->align(*at_subject_, aligned);
    for (std::size_t i = 0; i < choice.size(); ++i) {
      EXPECT_EQ(actual[i].pixels, expected[i].pixels);
      EXPECT_NEAR(actual[i].score, expected[i].score, test::kPointVerdict);
      EXPECT_LT(test::farthestCorner(
                    scene_.object, also_moved[i].camera_from_object, moved[i].camera_from_object),
                test::kAlignedMm);
    }
  }
}

TEST_P(RefineParity, RenderedSurfacesAreAlignedAlike) {
  const std::vector<IcpResult> expected = host().refine->alignSurfaces(*at_host_, renderTasks());
  const std::vector<IcpResult> actual =
      subject().refine->alignSurfaces(*at_subject_, renderTasks());
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT(test::farthestCorner(
                  scene_.object, actual[i].camera_from_object, expected[i].camera_from_object),
              test::kAlignedSurfaceMm);
  }
}

TEST_P(RefineParity, RenderedSurfacesAreJudgedAlike) {
  const std::vector<CheckResult> expected = host().refine->judgeSurfaces(*at_host_, renderTasks());
  const std::vector<CheckResult> actual =
      subject().refine->judgeSurfaces(*at_subject_, renderTasks());
  ASSERT_EQ(actual.size(), expected.size());
  EXPECT_GT(expected[1].score, expected[0].score) << "the truth must be the better pose";
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(
        static_cast<double>(actual[i].pixels) / expected[i].pixels, 1.0, test::kBorderShare);
    EXPECT_NEAR(actual[i].score, expected[i].score, static_cast<double>(test::kBorderShare));
  }
}

TEST_P(RefineParity, SurfacesWithoutPointsAreRefused) {
  std::vector<RenderTask> tasks = renderTasks();
  tasks.back().max_points = 0;
  EXPECT_THROW(host().refine->alignSurfaces(*at_host_, tasks), Error);
  EXPECT_THROW(subject().refine->alignSurfaces(*at_subject_, tasks), Error);
  static_cast<void>(
      subject().probe->median(scene_.depth.depth_mm));  // for the fixture's proof of work
}

TEST_P(RefineParity, NothingToDoGivesNothing) {
  EXPECT_TRUE(subject().refine->align(*at_subject_, {}).empty());
  EXPECT_TRUE(subject().refine->judge(*at_subject_, {}).empty());
  EXPECT_TRUE(subject().refine->alignSurfaces(*at_subject_, {}).empty());
  EXPECT_TRUE(subject().refine->judgeSurfaces(*at_subject_, {}).empty());
  static_cast<void>(
      subject().probe->median(scene_.depth.depth_mm));  // for the fixture's proof of work
}

TEST_P(RefineParity, AResidentDepthIsPreparedAsTheImageAndItsMask) {
  OrthoCamera camera;
  camera.width = 96;
  camera.height = 80;
  camera.pixel_mm = scene_.object.pixel_mm;
  const PixelBox region{10, 4, 150, 110};
  const SceneChannels expected =
      test::prepared(host(), scene_.depth, keep_, {camera, region})->download();
  const SceneChannels actual =
      subject().scenes->prepare(*at_subject_, {{camera, region}}, {}).front()->download();
  EXPECT_EQ(test::differences(actual.range_px, expected.range_px), 0);
  EXPECT_EQ(test::differences(actual.edges, expected.edges), 0);
}

}  // namespace
}  // namespace rangepose
