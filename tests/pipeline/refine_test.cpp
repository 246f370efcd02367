// What tells two poses apart may be less than what they are off: a closer look must bring each of
// them to rest before they are compared.
#include "pipeline/refine.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "pipeline/candidates.h"
#include "pipeline/pose_distance.h"
#include "stages/reference_host.h"
#include "stages/stage_set.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

class RefineTiesTest : public testing::Test {
 protected:
  RefineTiesTest() {
    ReferenceObject object = describeObject(
        test::meshOf(test::bracketBoxes()), 1, 64, uniformRotations(1), channelOptionsFor(64));
    host::renderReferences(object, channelOptionsFor(64), {});
    database_.objects = {object};
    right_.rotation = rotationFromVector({-0.7, 1.9, 0.4});
    right_.translation_mm = glm::dvec3(10.0, 5.0, 500.0) - right_.rotation * object.center_mm;
    image_.camera = test::pinholeCamera(640, 480, 1000.0);
    image_.depth_mm = Image<float>(640, 480, 0.0f);
    test::measure(image_, object.mesh, right_);
  }

  /// Largest distance between the poses' surfaces [mm].
  double errorMm(const Pose& pose) const {
    const ReferenceObject& object = database_.objects[0];
    return PoseDistance(object)(pose, right_) * object.diameter_mm;
  }

  /// Once checked with that rank.
  Candidate refined(const Pose& start, double rank) const {
    const Image<std::uint8_t> all(640, 480, 1);
    const std::unique_ptr<StageSet> stages = makeHostStages();
    const std::unique_ptr<ResidentDepth> depth = stages->uploadDepth(image_, all);
    const Enclosure nothing(image_, {}, std::nullopt, database_, kNoiseMm);
    std::vector<Candidate> candidates(1);
    candidates[0].pose = start;
    candidates[0].rank = rank;
    refineTies(candidates, database_, {image_, *depth, kNoiseMm, nothing, *stages});
    return candidates.at(0);
  }

  static constexpr double kNoiseMm = 0.1;
  ReferenceDatabase database_;
  Pose right_;
  DepthImage image_;
};

TEST_F(RefineTiesTest, APoseThatIsSlightlyOffComesToRestAtThePart) {
  const glm::dvec3 center = right_ * database_.objects[0].center_mm;
  Pose off = right_;
  off.rotation = rotationFromVector({0.006, -0.008, 0.005}) * right_.rotation;
  off.translation_mm =
      center + glm::dvec3(0.3, -0.2, 0.3) - off.rotation * database_.objects[0].center_mm;
  ASSERT_GT(errorMm(off), 0.4);
  const Candidate pose = refined(off, -10.0);
  EXPECT_LT(errorMm(pose.pose), 0.1) << "a twin may be told from it by as little";
  EXPECT_GT(pose.confidence, 0.9) << "it was not judged where it rests";
}

TEST_F(RefineTiesTest, APoseThatAlignmentMakesWorseStays) {
  Pose off = right_;
  off.translation_mm.x += 0.5;
  const double unreached = 100.0;
  const Candidate pose = refined(off, unreached);
  EXPECT_EQ(pose.pose.translation_mm.x, off.translation_mm.x);
  EXPECT_EQ(pose.rank, unreached);
}

}  // namespace
}  // namespace rangepose
