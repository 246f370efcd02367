// Blocks in plain places, looked at from straight above: what of them is free is known by heart.
#include "pipeline/picking.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/heap.h"
#include "sim/scanner.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kTableMm = 600.0;
constexpr double kHalfMm = 20.0;  // of a cube's side
/// A row of pixels along each border of a face.
constexpr double kShareTolerance = 0.04;

const ReferenceDatabase& cubes() {
  static const ReferenceDatabase database = [] {
    ReferenceDatabase result;
    const std::vector<test::Box> box = {{glm::dvec3(-kHalfMm), glm::dvec3(kHalfMm)}};
    result.objects.push_back(test::objectOf(box, 1, 64, 1));
    return result;
  }();
  return database;
}

/// Cubes that were found, and the image of them and of things that were not.
struct Scene {
  DepthImage image;
  std::vector<PoseEstimate> poses;

  Scene() {
    image.camera = test::pinholeCamera(320, 240, 300.0);
    test::measure(image, test::plateMesh(900, 900), {glm::dmat3(1.0), {0.0, 0.0, kTableMm}});
  }
  /// A cube with its centre at `center`, camera frame.
  void add(const glm::dvec3& center, double score = 0.95) {
    see(center);
    PoseEstimate& pose = poses.emplace_back();
    pose.pose.translation_mm = center;
    pose.confidence = score;
  }
  /// The same, but nobody knows what it is.
  void see(const glm::dvec3& center) {
    test::measure(image, cubes().objects[0].mesh, {glm::dmat3(1.0), center});
  }
  std::vector<Pick> picks(const PickOptions& options = {},
                          const std::optional<BinBox>& bin = std::nullopt) const {
    return pickingOrder(poses, image, 0.05, bin, cubes(), options);
  }
};

std::vector<std::size_t> orderOf(const std::vector<Pick>& picks) {
  std::vector<std::size_t> order;
  order.reserve(picks.size());
  for (const Pick& pick : picks) order.push_back(pick.pose);
  return order;
}

double freedomOf(const std::vector<Pick>& picks, std::size_t pose) {
  for (const Pick& pick : picks) {
    if (pick.pose == pose) return pick.freedom;
  }
  return -1.0;
}

/// On the table, z towards the camera, leaning by `lean_rad` towards the camera's x.
BinBox binLeaning(double lean_rad) {
  BinBox bin;
  bin.camera_from_bin.rotation =
      rotationFromVector({0.0, lean_rad, 0.0}) * rotationFromVector({std::numbers::pi, 0.0, 0.0});
  bin.camera_from_bin.translation_mm = {0.0, 0.0, kTableMm};
  bin.inner_size_mm = glm::dvec3(300.0);
  return bin;
}

TEST(PickingTest, NoPosesNoPicks) { EXPECT_TRUE(Scene().picks().empty()); }

TEST(PickingTest, AloneIsFree) {
  Scene scene;
  scene.add({60.0, -30.0, 580.0});
  const std::vector<Pick> picks = scene.picks();
  ASSERT_EQ(picks.size(), 1u);
  EXPECT_GT(picks[0].freedom, 0.99);
  EXPECT_NEAR(picks[0].height_mm, -580.0, 1e-9);
  EXPECT_NEAR(glm::distance(picks[0].approach, glm::dvec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(picks[0].position_mm, glm::dvec3(60, -30, 580)), 0.0, 1e-9);
}

TEST(PickingTest, WhatLiesUnderAnotherPartIsNotFree) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0}, 0.99);
  scene.add({kHalfMm, 0.0, 535.0}, 0.9);  // over the half with x > 0
  const std::vector<Pick> picks = scene.picks();
  EXPECT_THAT(orderOf(picks), ElementsAre(1, 0)) << "the upper one first, though less sure";
  EXPECT_NEAR(freedomOf(picks, 0), 0.5, kShareTolerance);
  EXPECT_GT(freedomOf(picks, 1), 0.99);
}

TEST(PickingTest, WhatWasNotRecognisedCoversToo) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0});
  scene.see({kHalfMm, 0.0, 535.0});
  EXPECT_NEAR(freedomOf(scene.picks(), 0), 0.5, kShareTolerance);
}

TEST(PickingTest, PartsSideBySideLeaveEachOtherFree) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0});
  scene.add({2.0 * kHalfMm, 0.0, 580.0});
  EXPECT_GT(freedomOf(scene.picks(), 0), 0.97);
  EXPECT_GT(freedomOf(scene.picks(), 1), 0.97);
}

TEST(PickingTest, BinTellsWhereAboveIs) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0});
  scene.add({80.0, 0.0, 500.0});  // at 45 degrees over the first, beside it for the camera
  EXPECT_GT(freedomOf(scene.picks(), 0), 0.97);
  const std::vector<Pick> level = scene.picks({}, binLeaning(0.0));
  EXPECT_GT(freedomOf(level, 0), 0.97);
  EXPECT_NEAR(level[0].height_mm, 100.0, 1e-9) << "the upper one, over the bin's floor";
  EXPECT_NEAR(level[1].height_mm, 20.0, 1e-9);
  EXPECT_LT(freedomOf(scene.picks({}, binLeaning(-0.25 * std::numbers::pi)), 0), 0.1);
}

TEST(PickingTest, ToolThatMayLeanReachesUnderAnOverhang) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0});
  scene.add({10.0, 0.0, 500.0});
  PickOptions options;
  const double straight = freedomOf(scene.picks(options), 0);
  EXPECT_NEAR(straight, 0.25, kShareTolerance);
  options.cone_rad = 0.7;
  const std::vector<Pick> picks = scene.picks(options);
  EXPECT_GT(freedomOf(picks, 0), 0.9);
  const glm::dvec3 approach = picks[1].pose == 0 ? picks[1].approach : picks[0].approach;
  EXPECT_NEAR(glm::length(approach), 1.0, 1e-9);
  EXPECT_GE(approach.z, std::cos(0.7) - 1e-9) << "within the cone";
  EXPECT_GT(approach.x, 0.1) << "from the side where nothing lies";
}

TEST(PickingTest, CoveredPartsAreLeftOut) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0});
  scene.add({kHalfMm, 0.0, 535.0});
  PickOptions options;
  options.min_freedom = 0.6;
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre(1));
  options.min_freedom = 0.4;
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre(1, 0));
}

/// From left to right higher and less sure.
Scene threeInARow() {
  Scene scene;
  scene.add({-80.0, 0.0, 580.0}, 0.97);
  scene.add({0.0, 0.0, 560.0}, 0.93);
  scene.add({80.0, 0.0, 540.0}, 0.75);
  return scene;
}

TEST(PickingTest, OfEquallyGoodPartsTheHighestIsFirst) {
  const Scene scene = threeInARow();
  EXPECT_THAT(orderOf(scene.picks()), ElementsAre(1, 0, 2)) << "0.75 is another step";
}

TEST(PickingTest, PartsNearTheArmAreFirst) {
  const Scene scene = threeInARow();
  PickOptions options;
  options.arm_mm = glm::dvec3(-500.0, 0.0, 500.0);
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre(0, 1, 2));
  options.arm_mm = glm::dvec3(500.0, 0.0, 500.0);
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre(1, 0, 2)) << "not at any price";
}

TEST(PickingTest, WorkspaceIsInTheFrameOfTheBin) {
  Scene scene;
  scene.add({-80.0, 0.0, 580.0});
  scene.add({80.0, 0.0, 580.0});
  PickOptions options;
  options.workspace = Workspace{{0.0, -50.0, 0.0}, {100.0, 50.0, 100.0}};
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre()) << "z is 580 in the camera's frame";
  EXPECT_THAT(orderOf(scene.picks(options, binLeaning(0.0))), ElementsAre(1));
}

TEST(PickingTest, PartOutOfReachCoversNevertheless) {
  Scene scene;
  scene.add({0.0, 0.0, 580.0});
  scene.add({kHalfMm, 0.0, 535.0});
  PickOptions options;
  options.workspace = Workspace{{-5.0, -5.0, 500.0}, {5.0, 5.0, 600.0}};
  const std::vector<Pick> picks = scene.picks(options);
  EXPECT_THAT(orderOf(picks), ElementsAre(0));
  EXPECT_NEAR(freedomOf(picks, 0), 0.5, kShareTolerance);
}

TEST(PickingTest, FewPicksAreTheSurestWithinReach) {
  const Scene scene = threeInARow();
  PickOptions options;
  options.max_picks = 1;
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre(0));
  options.workspace = Workspace{{-10.0, -50.0, 0.0}, {100.0, 50.0, 1000.0}};
  EXPECT_THAT(orderOf(scene.picks(options)), ElementsAre(1));
}

/// Of a heap scanned along the approach, each part is as free as it is visible; whether those above
/// it were found, or only measured.
TEST(PickingTest, FreedomIsWhatIsVisibleFromTheTool) {
  const Mesh& cube = cubes().objects[0].mesh;
  HeapOptions heap;
  heap.count = 10;
  heap.seed = 5;
  ScannerOptions scanner;
  scanner.orthographic = true;
  scanner.tilt_rad = 0.0;
  const Scan scan = scanHeap({cube}, makeHeap({cube}, heap), scanner);
  int covered = 0;
  for (const std::size_t every : {1, 2}) {
    std::vector<PoseEstimate> poses;
    std::vector<double> visible;
    for (std::size_t i = 0; i < scan.truth.size(); i += every) {
      poses.emplace_back().pose = scan.truth[i].camera_from_object;
      visible.push_back(scan.truth[i].visible_fraction);
    }
    for (const Pick& pick : pickingOrder(poses, scan.image, 0.1, std::nullopt, cubes(), {})) {
      EXPECT_NEAR(pick.freedom, visible[pick.pose], 0.08) << pick.pose << ", every " << every;
      covered += visible[pick.pose] < 0.8 ? 1 : 0;
    }
  }
  EXPECT_GE(covered, 3) << "or else the heap is too flat to show anything";
}

TEST(PickingTest, BadOptionsAreNamed) {
  const auto errorWith = [](const auto& change) -> std::string {
    PickOptions options;
    change(options);
    try {
      options.check();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(errorWith([](PickOptions& o) { o.cone_rad = 1.5; }), HasSubstr("cone_rad"));
  EXPECT_THAT(errorWith([](PickOptions& o) { o.min_freedom = 1.1; }), HasSubstr("min_freedom"));
  EXPECT_THAT(errorWith([](PickOptions& o) { o.max_picks = -1; }), HasSubstr("max_picks"));
  EXPECT_THAT(errorWith([](PickOptions& o) { o.workspace.emplace(); }), HasSubstr("workspace"));
  EXPECT_THAT(errorWith([](PickOptions& o) { o.arm_mm = glm::dvec3(NAN); }), HasSubstr("arm_mm"));
}

}  // namespace
}  // namespace rangepose
