// A plate lies on a block. Where it is known, the block under it is not doubted: else what others
// lie on is missed, and those are most parts of a bin.
#include "pipeline/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "pipeline/candidates.h"
#include "pipeline/explained_pixels.h"
#include "pipeline/selection.h"
#include "stages/check_host.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

constexpr double kPlateMm = 6.0;
constexpr double kNoiseMm = 0.05;

ReferenceObject rendered(const test::Box& box, int id) {
  ReferenceObject object =
      describeObject(test::meshOf({box}), id, 64, uniformRotations(1), channelOptionsFor(64));
  host::renderReferences(object, channelOptionsFor(64), {});
  return object;
}

class OcclusionTest : public testing::Test {
 protected:
  OcclusionTest() {
    // The block's top lies at z = 0, the plate on one half of it.
    database_.objects = {rendered({{-40.0, -30.0, 0.0}, {40.0, 30.0, 25.0}}, 1),
                         rendered({{-55.0, -35.0, -kPlateMm}, {0.0, 35.0, 0.0}}, 2)};
    image_.camera = test::pinholeCamera(320, 240, 600.0);
    image_.depth_mm = Image<float>(320, 240, 0.0f);
    for (const ReferenceObject& object : database_.objects)
      test::measure(image_, object.mesh, pose_);
    options_.tolerance_mm = 2.0;
  }

  struct Seen {
    std::vector<std::int32_t> explained;
    std::vector<float> exit_mm;
    std::vector<BuriedPixel> buried;
  };
  Seen seen(int object, const Pose& pose) const {
    const ReferenceObject& of = database_.objects[static_cast<std::size_t>(object)];
    const SurfaceWindow window =
        windowAround(image_.camera, pose * of.center_mm, of.radius_mm, 1000);
    const Image<SurfaceTexel> surface = host::renderSurface(of.mesh, image_.camera, pose, window);
    Seen result;
    result.explained = explainedPixels(surface, window, image_, options_.tolerance_mm);
    result.exit_mm = exitDepths(of.mesh, pose, image_.camera, window, result.explained);
    result.buried = judgedPixels(surface, window, image_, options_).buried;
    return result;
  }
  Pose shifted(double z_mm) const {
    return {pose_.rotation, pose_.translation_mm + glm::dvec3(0.0, 0.0, z_mm)};
  }
  /// As the pipeline checks it.
  Candidate checked(int object) const {
    const ReferenceObject& of = database_.objects[static_cast<std::size_t>(object)];
    const RenderTask task = surfaceTask(of, pose_, image_.camera, kNoiseMm);
    Candidate candidate;
    candidate.object = object;
    candidate.pose = pose_;
    const CheckResult check =
        host::check(host::renderSurface(of.mesh, image_.camera, pose_, task.window),
                    task.window,
                    image_,
                    task.sphere(),
                    task.check);
    setEvidence(candidate, check, meanVisibleArea(of));
    return candidate;
  }

  Pose pose_{glm::dmat3(1.0), {0.0, 0.0, 400.0}};
  ReferenceDatabase database_;
  DepthImage image_;
  CheckOptions options_;
};

TEST_F(OcclusionTest, RaysLeaveThePlateAtItsBack) {
  const Seen plate = seen(1, pose_);
  ASSERT_GT(plate.explained.size(), 1000u);
  // Some near its border leave through a side.
  const auto at_back = std::count_if(plate.exit_mm.begin(), plate.exit_mm.end(), [](float mm) {
    return std::abs(mm - 400.0f) < 1e-3f;
  });
  EXPECT_GT(static_cast<double>(at_back), 0.95 * static_cast<double>(plate.exit_mm.size()));
  for (const float mm : plate.exit_mm) ASSERT_GT(mm, 400.0 - kPlateMm);
  EXPECT_TRUE(plate.buried.empty());
}

TEST_F(OcclusionTest, WhatLiesUnderAFoundPartIsCovered) {
  const Seen block = seen(0, pose_);
  const Seen plate = seen(1, pose_);
  ASSERT_GT(block.buried.size(), 1000u);
  FoundParts found(image_.depth_mm.size());
  EXPECT_EQ(found.coveredShare(block.explained, block.buried, 0.25), 0.0) << "nothing is found yet";
  found.add(plate.explained, plate.exit_mm);
  EXPECT_GT(found.coveredShare(block.explained, block.buried, 0.25), 0.95);
}

TEST_F(OcclusionTest, WhatReachesIntoAFoundPartIsNot) {
  const Seen inside = seen(0, shifted(-3.0));  // between the plate's two faces
  const Seen plate = seen(1, pose_);
  ASSERT_GT(inside.buried.size(), 1000u);
  FoundParts found(image_.depth_mm.size());
  found.add(plate.explained, plate.exit_mm);
  EXPECT_EQ(found.coveredShare(inside.explained, inside.buried, 0.25), 0.0);
}

TEST_F(OcclusionTest, ARivalForTheSameSurfaceHidesNothing) {
  const Seen block = seen(0, pose_);
  FoundParts found(image_.depth_mm.size());
  std::vector<std::int32_t> all = block.explained;
  for (const BuriedPixel& pixel : block.buried) all.push_back(pixel.at);
  found.add(all, std::vector<float>(all.size(), 1.0f));
  EXPECT_EQ(found.coveredShare(block.explained, block.buried, 0.25), 0.0);
}

TEST_F(OcclusionTest, ThePartBelowIsSurerOnceThePartOnItIsFound) {
  Selection selection(image_, database_, kNoiseMm);
  const auto confidenceOfBlock = [&] {
    for (const Candidate& candidate : selection.choose())
      if (candidate.object == 0) return candidate.confidence;
    return 0.0;
  };
  const Candidate block = checked(0);
  ASSERT_GT(block.check.buried, 0.2);
  selection.add({block});
  const double alone = confidenceOfBlock();
  EXPECT_LT(alone, 0.7);
  selection.add({checked(1)});
  EXPECT_GT(confidenceOfBlock(), alone + 0.1);
}

}  // namespace
}  // namespace rangepose
