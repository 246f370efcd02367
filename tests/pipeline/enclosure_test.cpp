// A part that is partly covered has several poses that explain what is seen of it. Those whose rest
// would lie under the floor or in a wall are none; without this a robot is sent to them.
#include "pipeline/enclosure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/orientation_grid.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

constexpr double kFloorMm = 600.0;
constexpr double kNoiseMm = 0.05;

/// A rod of 100 x 20 x 20 mm over the floor of a bin, seen from straight above.
class EnclosureTest : public testing::Test {
 protected:
  EnclosureTest() {
    const Mesh rod = test::meshOf({{{-50, -10, -10}, {50, 10, 10}}});
    database_.objects = {describeObject(rod, 1, 64, uniformRotations(1), channelOptionsFor(64))};
    image_.camera = test::pinholeCamera(320, 240, 500.0);
    cover(kFloorMm);
    // z up out of the bin, towards the camera.
    bin_.camera_from_bin = {rotationFromVector({M_PI, 0.0, 0.0}), {0.0, 0.0, kFloorMm}};
    bin_.inner_size_mm = {200.0, 150.0, 80.0};
  }

  void cover(double depth_mm) {
    image_.depth_mm = Image<float>(320, 240, static_cast<float>(depth_mm));
  }
  Enclosure floorOnly() const {
    return {image_, {{glm::dvec3(0, 0, -1), -kFloorMm}}, std::nullopt, database_, kNoiseMm};
  }
  Enclosure bin() const { return {image_, {}, bin_, database_, kNoiseMm}; }

  /// Centre of the rod: across the image, and over the floor.
  static Pose lying(double x_mm, double over_floor_mm) {
    return {glm::dmat3(1.0), {x_mm, 0.0, kFloorMm - over_floor_mm}};
  }

  ReferenceDatabase database_;
  DepthImage image_;
  BinBox bin_;
};

TEST_F(EnclosureTest, FloorAndWallsBoundABinButNotTheAirAboveIt) {
  const Enclosure enclosure = bin();
  EXPECT_NEAR(enclosure.beyondMm({0.0, 0.0, kFloorMm + 7.0}), 7.0, 1e-9);
  EXPECT_NEAR(enclosure.beyondMm({104.0, 0.0, kFloorMm - 30.0}), 4.0, 1e-9);
  EXPECT_NEAR(enclosure.beyondMm({0.0, -78.0, kFloorMm - 30.0}), 3.0, 1e-9);
  EXPECT_LT(enclosure.beyondMm({104.0, 0.0, kFloorMm - 90.0}), 0.0) << "above the wall";
  EXPECT_LT(enclosure.beyondMm({0.0, 0.0, kFloorMm - 30.0}), 0.0);
  EXPECT_NEAR(floorOnly().beyondMm({104.0, 0.0, kFloorMm + 2.0}), 2.0, 1e-9);
}

TEST_F(EnclosureTest, APartOnTheFloorIsInside) {
  for (const Enclosure& enclosure : {floorOnly(), bin()}) {
    EXPECT_EQ(enclosure.outsideShare(0, lying(0.0, 10.0)), 0.0);
    EXPECT_EQ(enclosure.outsideShare(0, lying(0.0, 7.0)), 0.0) << "a bin is known to so much";
    EXPECT_TRUE(enclosure.holds(0, lying(0.0, 10.0), 0.0));
  }
}

TEST_F(EnclosureTest, APartThatSinksThroughTheFloorIsNot) {
  for (const Enclosure& enclosure : {floorOnly(), bin()}) {
    // The margin is 5.3 mm: the lowest 9.7 mm are outside, 4,340 of the rod's 8,800 mm^2.
    EXPECT_NEAR(enclosure.outsideShare(0, lying(0.0, -5.1)), 0.49, 0.03);
    EXPECT_EQ(enclosure.outsideShare(0, lying(0.0, -40.0)), 1.0);
    EXPECT_FALSE(enclosure.holds(0, lying(0.0, -5.0), 0.0));
    EXPECT_TRUE(enclosure.holds(0, lying(0.0, -5.0), 15.0)) << "it may still come up";
  }
}

TEST_F(EnclosureTest, NeitherIsOneInAWall) {
  // From 50 to 150 mm, the wall stands at 100 mm; what rises above the wall covers all.
  cover(kFloorMm - 90.0);
  EXPECT_NEAR(bin().outsideShare(0, lying(100.0, 30.0)), 0.45, 0.05);
  EXPECT_FALSE(bin().holds(0, lying(100.0, 30.0), 0.0));
  EXPECT_TRUE(floorOnly().holds(0, lying(100.0, 30.0), 0.0));
}

TEST_F(EnclosureTest, WhatIsSeenOutsideIsNotHiddenByAWall) {
  // The box is only where the bin is said to be: a part that leans out of it is seen to do so.
  const Pose pose = lying(100.0, 70.0);
  test::measure(image_, database_.objects[0].mesh, pose);
  EXPECT_LT(bin().outsideShare(0, pose), 0.02) << "a border pixel or two";
  EXPECT_TRUE(bin().holds(0, pose, 0.0));
}

TEST_F(EnclosureTest, NothingIsKnownWithoutDataOrBackground) {
  const Enclosure nothing(image_, {}, std::nullopt, database_, kNoiseMm);
  EXPECT_EQ(nothing.outsideShare(0, lying(0.0, -40.0)), 0.0);
  cover(0.0);
  EXPECT_EQ(bin().outsideShare(0, lying(0.0, -40.0)), 0.0);
  cover(kFloorMm);
  EXPECT_EQ(bin().outsideShare(0, lying(5000.0, -40.0)), 0.0) << "beside the image";
  EXPECT_EQ(bin().outsideShare(0, {glm::dmat3(1.0), glm::dvec3(NAN)}), 0.0);
}

}  // namespace
}  // namespace rangepose
