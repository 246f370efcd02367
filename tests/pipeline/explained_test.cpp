// Surface that a pose explains belongs to it: shared by two poses, one part is picked twice; taken
// too eagerly, the part beside it is missed.
#include "pipeline/explained.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

class ExplainedPixelsTest : public testing::Test {
 protected:
  ExplainedPixelsTest() {
    image_.camera = test::pinholeCamera(320, 240, 300.0);
    image_.depth_mm = Image<float>(320, 240, 0.0f);
    for (const double x : {-60.0, 60.0}) test::measure(image_, object_.mesh, partAt(x));
    foreground_ = Image<std::uint8_t>(320, 240, 0);
    std::transform(
        image_.depth_mm.begin(), image_.depth_mm.end(), foreground_.begin(), [](float mm) {
          return static_cast<std::uint8_t>(mm > 0.0f ? 1 : 0);
        });
  }

  Pose partAt(double x_mm) const {
    Pose pose;
    pose.rotation = rotationFromVector({-0.7, 1.9, 0.4});
    pose.translation_mm = glm::dvec3(x_mm, 0.0, 500.0) - pose.rotation * object_.center_mm;
    return pose;
  }

  /// Pixels of the foreground.
  double left() const {
    return static_cast<double>(std::count(foreground_.begin(), foreground_.end(), 1));
  }

  ReferenceObject object_ = describeObject(
      test::meshOf(test::bracketBoxes()), 1, 64, uniformRotations(1), channelOptionsFor(64));
  DepthImage image_;
  Image<std::uint8_t> foreground_;
  std::unique_ptr<StageSet> stages_ = makeHostStages();
};

TEST_F(ExplainedPixelsTest, ARightPoseTakesItsPartAndNoOther) {
  const double all = left();
  ASSERT_GT(all, 0.0);
  ExplainedPixels explained(image_, 0.1, *stages_);
  EXPECT_TRUE(explained.take(object_, partAt(-60.0), foreground_));
  EXPECT_NEAR(left(), 0.5 * all, 0.02 * all);
  EXPECT_TRUE(explained.take(object_, partAt(60.0), foreground_));
  EXPECT_EQ(left(), 0.0);
}

TEST_F(ExplainedPixelsTest, ASecondPoseOfTheSamePartIsRefused) {
  ExplainedPixels explained(image_, 0.1, *stages_);
  ASSERT_TRUE(explained.take(object_, partAt(-60.0), foreground_));
  const double before = left();
  EXPECT_FALSE(explained.take(object_, partAt(-60.0), foreground_));
  EXPECT_FALSE(explained.take(object_, partAt(-58.0), foreground_)) << "nearly the same";
  EXPECT_EQ(left(), before);
}

}  // namespace
}  // namespace rangepose
