// The bodies of the kernels by threads that really run side by side: the same bits as thread after
// thread, so no phase reads what another one still writes.
#include <gtest/gtest.h>

#include <memory>

#include "cuda/edt_body.h"
#include "cuda/refine_scene.h"
#include "cuda/search_scene.h"
#include "cuda/threaded_block.h"

namespace rangepose {
namespace {

constexpr int kThreads = 64;
using test::runThreaded;

TEST(ThreadedBodyTest, TheSearchOfAView) {
  const ReferenceObject object = test::renderedBracket(4, 32, 31);
  SearchOptions options;
  options.error.image_width_px = 32;
  const test::FusedInput in(object, test::windowWith(object, 2, 40), options);
  const std::vector<Hypothesis> expected = test::fusedOnHost<6, kThreads>(in);
  for (std::size_t view = 0; view < 4; ++view) {
    cuda::SearchShared shared{};
    Hypothesis answer;
    runThreaded<kThreads>([&](auto& block) {
      cuda::searchView<6>(block,
                          shared,
                          in.setup,
                          in.views.entries[view],
                          in.views.pixels.data(),
                          in.texels.data(),
                          in.seed_range_px,
                          answer);
    });
    EXPECT_EQ(answer.error, expected[view].error);
    EXPECT_EQ(answer.translation_px, expected[view].translation_px);
    EXPECT_EQ(answer.iterations, expected[view].iterations);
  }
}

TEST(ThreadedBodyTest, TheDistancesOfATile) {
  const Image<float> range = test::randomBlobs(50, 40, 2);
  const Image<float> edges = host::edges(range, 2.56f);
  const auto read_range = [&](int x, int y) { return range.at(x, y); };
  const auto read_edges = [&](int x, int y) { return edges.at(x, y); };
  auto shared = std::make_unique<cuda::EdtShared>();
  Image<float> actual(50, 40, -1.0f);
  for (const int x0 : {0, cuda::kEdtTile}) {
    for (const int y0 : {0, cuda::kEdtTile}) {
      const cuda::EdtTileSetup tile = {x0, y0, 50, 40, 7};
      runThreaded<kThreads>([&](auto& block) {
        cuda::edtTile(
            block, *shared, tile, read_range, read_edges, [&](int x, int y, const EdtTexel& texel) {
              actual.at(x, y) = edtRoot(texel);
            });
      });
    }
  }
  EXPECT_EQ(actual, host::distance(range, edges, 7));
}

class ThreadedRefineTest : public testing::Test {
 protected:
  ThreadedRefineTest() : scene_(1, false), points_(pointsOfView(scene_.object, 0, 150)) {}

  float read(bool where, int u, int v) const {
    return where ? scene_.depth.depth_mm.at(u, v) : 0.0f;
  }

  test::RefineScene scene_;
  std::vector<SurfacePoint> points_;
};

TEST_F(ThreadedRefineTest, TheAlignmentOfAPose) {
  const auto read_depth = [&](bool where, int u, int v) { return read(where, u, v); };
  const Camera& camera = scene_.depth.camera;
  const cuda::IcpTask task = scene_.icpTask(points_, {});
  cuda::IcpShared shared{};
  IcpResult expected;
  IcpResult actual;
  cuda::HostBlock<kThreads> host;
  cuda::alignPose(host, shared, task, camera, read_depth, points_.data(), expected);
  runThreaded<kThreads>([&](auto& block) {
    cuda::alignPose(block, shared, task, camera, read_depth, points_.data(), actual);
  });
  EXPECT_EQ(actual.camera_from_object.rotation, expected.camera_from_object.rotation);
  EXPECT_EQ(actual.camera_from_object.translation_mm, expected.camera_from_object.translation_mm);
  EXPECT_EQ(actual.rms_mm, expected.rms_mm);
  EXPECT_EQ(actual.iterations, 10);
}

TEST_F(ThreadedRefineTest, TheVerdictOnAPose) {
  const auto read_depth = [&](bool where, int u, int v) { return read(where, u, v); };
  cuda::PointsTask task;
  task.point_count = static_cast<int>(points_.size());
  task.camera_from_object = scene_.truth;
  CheckResult expected;
  CheckResult actual;
  cuda::HostBlock<kThreads> host;
  const Camera& camera = scene_.depth.camera;
  cuda::judgeTaskPoints(host, task, camera, read_depth, points_.data(), expected);
  runThreaded<kThreads>([&](auto& block) {
    cuda::judgeTaskPoints(block, task, camera, read_depth, points_.data(), actual);
  });
  EXPECT_EQ(actual.score, expected.score);
  EXPECT_EQ(actual.residual_mm, expected.residual_mm);
  EXPECT_GT(actual.explained, 0.1);
}

}  // namespace
}  // namespace rangepose
