// Whole frames of the CUDA path on the emulated device: what chains, moves and frees. Equal to the
// host's, whatever the order of blocks and threads, and with one clear line where a call fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "core/error.h"
#include "cuda/cuda_path.h"
#include "cuda/emulated/launch.h"
#include "cuda/emulated/runtime.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "pipeline/estimate.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose::cuda {
namespace {

using testing::Gt;
using testing::HasSubstr;
using testing::Not;

constexpr int kViews = 80;

Mesh bracket() {
  Mesh mesh = test::meshOf(test::bracketBoxes());
  for (glm::vec3& vertex : mesh.vertices) vertex *= 2.0f;
  mesh.name = "bracket";
  return mesh;
}

const ReferenceDatabase& brackets() {
  static const ReferenceDatabase database = [] {
    ReferenceDatabase made;
    made.objects.push_back(
        describeObject(bracket(), 1, 64, uniformRotations(kViews), channelOptionsFor(64)));
    host::renderReferences(made.objects.front(), channelOptionsFor(64), {});
    return made;
  }();
  return database;
}

/// Two brackets on a table.
const DepthImage& scene() {
  static const DepthImage image = [] {
    DepthImage made{test::pinholeCamera(320, 240, 300.0), Image<float>(320, 240, 0.0f)};
    test::measure(made, test::plateMesh(900.0, 900.0), {glm::dmat3(1.0), {0.0, 0.0, 560.0}});
    const ReferenceObject& part = brackets().objects.front();
    for (const auto& [turn, center] :
         {std::pair(glm::dvec3(-0.7, 1.9, 0.4), glm::dvec3(90.0, -15.0, 480.0)),
          std::pair(glm::dvec3(0.3, -0.8, 2.2), glm::dvec3(-90.0, 20.0, 490.0))}) {
      Pose pose;
      pose.rotation = rotationFromVector(turn);
      pose.translation_mm = center - pose.rotation * part.center_mm;
      test::measure(made, part.mesh, pose);
    }
    return made;
  }();
  return image;
}

Estimate frame(StageSet& stages, int poses) {
  EstimateOptions options;
  options.max_poses = poses;
  return estimatePoses(scene(), std::nullopt, brackets(), options, stages);
}

Estimate frameOnDevice(const PathOptions& options, int poses) {
  const Path path = openPath(options);
  return frame(*path.stages, poses);
}

void expectLikeHost(const Estimate& estimate, int poses) {
  const Estimate host = frame(*makeHostStages(), poses);
  ASSERT_THAT(host.poses.size(), Gt(0U));
  ASSERT_EQ(estimate.poses.size(), host.poses.size());
  for (std::size_t i = 0; i < host.poses.size(); ++i) {
    const PoseEstimate& ours = estimate.poses[i];
    const PoseEstimate& theirs = host.poses[i];
    EXPECT_NEAR(ours.confidence, theirs.confidence, 1e-4) << i;
    EXPECT_LT(glm::distance(ours.pose.translation_mm, theirs.pose.translation_mm), 0.005) << i;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(glm::distance(ours.pose.rotation[axis], theirs.pose.rotation[axis]), 1e-4) << i;
    }
  }
}

class FrameTest : public testing::TestWithParam<std::tuple<Interop, bool>> {
 protected:
  void TearDown() override {
    emulated::setShuffle(0);
    emulated::failNothing();
  }
  static PathOptions options() { return {std::get<0>(GetParam()), std::get<1>(GetParam())}; }
};

INSTANTIATE_TEST_SUITE_P(Ways,
                         FrameTest,
                         testing::Values(std::tuple(Interop::kGles, false),
                                         std::tuple(Interop::kGl, false),
                                         std::tuple(Interop::kCopy, false),
                                         std::tuple(Interop::kGles, true)),
                         [](const auto& way) {
                           return std::string(nameOf(std::get<0>(way.param))) +
                                  (std::get<1>(way.param) ? "_staged" : "_fused");
                         });

TEST_P(FrameTest, AFirstPoseIsTheHosts) { expectLikeHost(frameOnDevice(options(), 1), 1); }

class WholeFrameTest : public testing::Test {
 protected:
  void TearDown() override {
    emulated::setShuffle(0);
    emulated::failNothing();
  }
};

TEST_F(WholeFrameTest, AllPartsAreTheHosts) { expectLikeHost(frameOnDevice({}, 100), 100); }

TEST_F(WholeFrameTest, TheOrderOfBlocksAndThreadsDoesNotMatter) {
  const Estimate straight = frameOnDevice({}, 1);
  for (const unsigned seed : {1U, 2U}) {
    emulated::setShuffle(seed);
    const Estimate shuffled = frameOnDevice({}, 1);
    ASSERT_EQ(shuffled.poses.size(), straight.poses.size());
    EXPECT_EQ(shuffled.poses[0].pose.translation_mm, straight.poses[0].pose.translation_mm);
    EXPECT_EQ(shuffled.poses[0].pose.rotation, straight.poses[0].pose.rotation);
    EXPECT_EQ(shuffled.poses[0].confidence, straight.poses[0].confidence);
  }
}

TEST_F(WholeFrameTest, NothingIsLeftBehind) {
  const int before = emulated::alive().all();
  static_cast<void>(frameOnDevice({}, 1));
  EXPECT_EQ(emulated::alive().all(), before);
}

/// A call of the runtime, and the interop by which a frame makes it.
struct FailingCall {
  const char* function;
  Interop interop;
};

void PrintTo(const FailingCall& call, std::ostream* to) { *to << call.function; }

class FailingCallTest : public testing::TestWithParam<FailingCall> {
 protected:
  void TearDown() override { emulated::failNothing(); }

  /// Fails the call that is made as the `nth`; false where there were fewer.
  static bool failsOnce(int nth) {
    emulated::failCall(GetParam().function, nth, cudaErrorUnknown);
    try {
      static_cast<void>(frameOnDevice({GetParam().interop, false}, 1));
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("cudaErrorUnknown")) << nth;
      EXPECT_THAT(error.what(), Not(HasSubstr("\n"))) << nth;
      return true;
    }
    emulated::failNothing();
    return false;
  }
};

INSTANTIATE_TEST_SUITE_P(Calls,
                         FailingCallTest,
                         testing::Values(FailingCall{"cudaGetDeviceCount", Interop::kGles},
                                         FailingCall{"cudaMalloc", Interop::kGles},
                                         FailingCall{"cudaMallocHost", Interop::kCopy},
                                         FailingCall{"cudaMallocArray", Interop::kCopy},
                                         FailingCall{"cudaMemcpyAsync", Interop::kGles},
                                         FailingCall{"cudaMemsetAsync", Interop::kGles},
                                         FailingCall{"cudaMemcpy2DToArrayAsync", Interop::kCopy},
                                         FailingCall{"cudaMemcpy2DFromArrayAsync", Interop::kGles},
                                         FailingCall{"cudaCreateTextureObject", Interop::kGles},
                                         FailingCall{"cudaCreateSurfaceObject", Interop::kGles},
                                         FailingCall{"cudaStreamCreateWithFlags", Interop::kCopy},
                                         FailingCall{"cudaStreamSynchronize", Interop::kGles},
                                         FailingCall{"cudaStreamSynchronize", Interop::kCopy},
                                         FailingCall{"cudaGraphicsGLRegisterImage", Interop::kGles},
                                         FailingCall{"cudaGraphicsMapResources", Interop::kGles},
                                         FailingCall{"cudaGraphicsSubResourceGetMappedArray",
                                                     Interop::kGles},
                                         FailingCall{"kernel", Interop::kGles}),
                         [](const auto& call) {
                           return std::string(call.param.function) + '_' +
                                  nameOf(call.param.interop);
                         });

TEST_P(FailingCallTest, EndsInOneLineAndLeavesNothingBehind) {
  const int before = emulated::alive().all();
  int failed = 0;
  for (const int nth : {1, 3, 9, 30, 90}) {
    // The first calls are made to see what is shared: another way is tried then.
    failed += failsOnce(nth) ? 1 : 0;
    ASSERT_EQ(emulated::alive().all(), before) << nth;
    EXPECT_EQ(cudaGetLastError(), cudaSuccess) << nth;
  }
  EXPECT_THAT(failed, Gt(0)) << "the frame does not make this call";
  expectLikeHost(frameOnDevice({GetParam().interop, false}, 1), 1);
}

}  // namespace
}  // namespace rangepose::cuda
