// What tells two poses apart may be less than what they are off: a closer look must bring each of
// them to rest before they are compared. And a tool goes where the last alignment says.
#include "pipeline/refine.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <random>
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

class RefinedPoseTest : public testing::Test {
 protected:
  RefinedPoseTest() {
    ReferenceObject object = describeObject(
        test::meshOf(test::bracketBoxes()), 1, 64, uniformRotations(1), channelOptionsFor(64));
    host::renderReferences(object, channelOptionsFor(64), {});
    database_.objects = {object};
    right_.rotation = rotationFromVector({0.7, 2.4, 0.4});  // three of its faces are seen
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

  /// The part, turned about its centre and shifted by that much.
  Pose off(const glm::dvec3& turn_rad, const glm::dvec3& shift_mm) const {
    const glm::dvec3& center_mm = database_.objects[0].center_mm;
    Pose pose;
    pose.rotation = rotationFromVector(turn_rad) * right_.rotation;
    pose.translation_mm = right_ * center_mm + shift_mm - pose.rotation * center_mm;
    return pose;
  }

  void addNoise(double most_mm) {
    std::mt19937 random(1);
    for (float& depth_mm : image_.depth_mm) {
      const double share = static_cast<double>(random()) / 4294967296.0;
      if (depth_mm > 0.0f) depth_mm += static_cast<float>(most_mm * (2.0 * share - 1.0));
    }
  }

  using Refine = void (*)(std::vector<Candidate>&, const ReferenceDatabase&, const RefineScene&);
  /// Once checked with that rank.
  Candidate refined(Refine refine, const Pose& start, double rank) const {
    const Image<std::uint8_t> all(640, 480, 1);
    const std::unique_ptr<StageSet> stages = makeHostStages();
    const std::unique_ptr<ResidentDepth> depth = stages->foreground->upload(image_, all);
    const Enclosure nothing(image_, {}, std::nullopt, database_, kNoiseMm);
    std::vector<Candidate> candidates(1);
    candidates[0].pose = start;
    candidates[0].rank = rank;
    refine(candidates, database_, {image_, *depth, kNoiseMm, nothing, *stages});
    return candidates.at(0);
  }

  static constexpr double kNoiseMm = 0.1;
  ReferenceDatabase database_;
  Pose right_;
  DepthImage image_;
};

TEST_F(RefinedPoseTest, OneOfTwoRivalsThatIsSlightlyOffComesToRestAtThePart) {
  const Pose start = off({0.006, -0.008, 0.005}, {0.3, -0.2, 0.3});
  ASSERT_GT(errorMm(start), 0.4);
  const Candidate pose = refined(refineTies, start, -10.0);
  EXPECT_LT(errorMm(pose.pose), 0.1) << "a twin may be told from it by as little";
  EXPECT_GT(pose.confidence, 0.9) << "it was not judged where it rests";
}

TEST_F(RefinedPoseTest, AllPixelsTogetherKnowThePoseFarBetterThanOneIsMeasured) {
  const double noise_mm = 0.2;
  addNoise(noise_mm);
  const Pose start = off({0.004, -0.006, 0.004}, {0.2, -0.2, 0.2});
  ASSERT_GT(errorMm(start), noise_mm);
  const Candidate pose = refined(settle, start, -10.0);
  EXPECT_LT(errorMm(pose.pose), 0.1 * noise_mm) << "what is inserted there would not fit";
  EXPECT_GT(pose.confidence, 0.9) << "it was not judged where it rests";
}

TEST_F(RefinedPoseTest, ATwinThatIsBeyondHopeIsDropped) {
  const Image<std::uint8_t> all(640, 480, 1);
  const std::unique_ptr<StageSet> stages = makeHostStages();
  const std::unique_ptr<ResidentDepth> depth = stages->foreground->upload(image_, all);
  const Enclosure nothing(image_, {}, std::nullopt, database_, kNoiseMm);
  std::vector<Candidate> candidates(2);
  for (Candidate& candidate : candidates) candidate.rank = 9.0;  // that of the pose it is a twin of
  candidates[0].pose = right_;
  candidates[1].pose = off({0.0, 2.0, 0.0}, {0.0, 0.0, -60.0});
  checkTwins(candidates, database_, {image_, *depth, kNoiseMm, nothing, *stages});
  ASSERT_EQ(candidates.size(), 1U) << "what was known of its twin was taken for its own";
  EXPECT_LT(errorMm(candidates[0].pose), 0.01) << "it must lie where its twin lies";
  EXPECT_NE(candidates[0].rank, 9.0);
}

TEST_F(RefinedPoseTest, APoseThatAlignmentMakesWorseStays) {
  const Pose start = off({}, {0.5, 0.0, 0.0});
  const double unreached = 100.0;
  for (const Refine refine : {refineTies, settle}) {
    const Candidate pose = refined(refine, start, unreached);
    EXPECT_EQ(pose.pose.translation_mm.x, start.translation_mm.x);
    EXPECT_EQ(pose.rank, unreached);
  }
}

}  // namespace
}  // namespace rangepose
