// Duplicates are merged by this distance: too large between symmetric copies, and copies of one
// answer take the place of others; too small between different poses, and the right one is lost.
#include "pipeline/pose_distance.h"

#include <gtest/gtest.h>

#include <numbers>

namespace rangepose {
namespace {

constexpr double kPi = std::numbers::pi;

ReferenceObject objectWith(const Symmetries& symmetries) {
  ReferenceObject object;
  object.symmetries = symmetries;
  object.center_mm = {5.0, -3.0, 8.0};
  object.radius_mm = 50.0;
  object.diameter_mm = 100.0;
  return object;
}

/// A rotation about a line through the object's centre.
Pose turned(const ReferenceObject& object, const glm::dvec3& vector) {
  const glm::dmat3 rotation = rotationFromVector(vector);
  return {rotation, object.center_mm - rotation * object.center_mm};
}

const Pose kSomewhere{rotationFromVector({0.4, -1.1, 0.7}), {30.0, -20.0, 700.0}};

TEST(PoseDistanceTest, ShiftCountsAsShareOfTheDiameter) {
  const ReferenceObject object = objectWith({});
  Pose shifted = kSomewhere;
  shifted.translation_mm += glm::dvec3(0.0, 3.0, 4.0);
  EXPECT_NEAR(PoseDistance(object)(kSomewhere, shifted), 0.05, 1e-12);
}

TEST(PoseDistanceTest, TurnOfAPartWithoutSymmetryCounts) {
  const ReferenceObject object = objectWith({});
  const Pose half = kSomewhere * turned(object, {0.0, 0.0, kPi});
  // Four of six points, 30 mm from the axis, move by 60 mm.
  EXPECT_NEAR(PoseDistance(object)(kSomewhere, half), 4.0 * 60.0 / 6.0 / 100.0, 1e-12);
}

TEST(PoseDistanceTest, SymmetricCopiesAreTheSame) {
  ReferenceObject object = objectWith({});
  const Pose half = turned(object, {0.0, 0.0, kPi});
  object.symmetries.discrete = {half};
  const PoseDistance distance(object);
  EXPECT_NEAR(distance(kSomewhere, kSomewhere * half), 0.0, 1e-12);
  EXPECT_TRUE(distance.below(0.01, kSomewhere, kSomewhere * half));
  const Pose quarter = turned(object, {0.0, 0.0, 0.5 * kPi});
  EXPECT_GT(distance(kSomewhere, kSomewhere * quarter), 0.2);
  EXPECT_FALSE(distance.below(0.1, kSomewhere, kSomewhere * quarter));
}

TEST(PoseDistanceTest, TurnAboutTheAxisOfARevolutionIsNoDifference) {
  ReferenceObject object = objectWith({});
  object.symmetries.continuous = {{{0.0, 0.0, 1.0}, object.center_mm}};
  const PoseDistance distance(object);
  EXPECT_NEAR(distance(kSomewhere, kSomewhere * turned(object, {0.0, 0.0, 1.234})), 0.0, 1e-12);
  EXPECT_GT(distance(kSomewhere, kSomewhere * turned(object, {0.3, 0.0, 0.0})), 0.08);
  // Ends alike or not.
  const Pose over = turned(object, {kPi, 0.0, 0.0});
  EXPECT_GT(distance(kSomewhere, kSomewhere * over), 0.5);
  object.symmetries.discrete = {over};
  EXPECT_NEAR(PoseDistance(object)(kSomewhere, kSomewhere * over), 0.0, 1e-12);
}

TEST(PoseDistanceTest, BelowAgreesWithTheDistance) {
  ReferenceObject object = objectWith({});
  object.symmetries.discrete = {turned(object, {0.0, kPi, 0.0})};
  const PoseDistance distance(object);
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i;
    Pose other = kSomewhere * turned(object, {0.3 * t, t, -0.1 * t});
    other.translation_mm += glm::dvec3(2.0 * t, -t, 3.0 * t);
    EXPECT_EQ(distance.below(0.04, kSomewhere, other), distance(kSomewhere, other) < 0.04) << i;
  }
}

/// Of `order` turns about a line, all but the identity.
Symmetries turnsAbout(const glm::dvec3& axis, const glm::dvec3& point_mm, int order) {
  Symmetries symmetries;
  for (int i = 1; i < order; ++i) {
    const glm::dmat3 rotation = rotationFromVector(2.0 * kPi * i / order * glm::normalize(axis));
    symmetries.discrete.push_back({rotation, point_mm - rotation * point_mm});
  }
  return symmetries;
}

class AxisBesideTheCentreTest : public testing::TestWithParam<int> {};

// Files may give the symmetries of a part, and any point may be the centre of its sphere: a plate
// with three ears would be its own rival, and no pose of it sure.
TEST_P(AxisBesideTheCentreTest, BelowAgreesWithTheDistance) {
  ReferenceObject object = objectWith({});
  object.symmetries = turnsAbout({0.2, -0.4, 1.0}, {17.0, 1.0, 2.0}, GetParam());
  const PoseDistance distance(object);
  int close = 0;
  for (const Pose& symmetric : object.symmetries.discrete) {
    for (int i = 0; i < 200; ++i) {
      const double t = 0.005 * i;
      Pose other = kSomewhere * symmetric * turned(object, {0.3 * t, 0.2 * t, -0.1 * t});
      other.translation_mm += glm::dvec3(2.0 * t, -t, 3.0 * t);
      const double apart = distance(kSomewhere, other);
      EXPECT_EQ(distance.below(0.04, kSomewhere, other), apart < 0.04) << i;
      PoseList list(object);
      list.add(kSomewhere);
      EXPECT_EQ(list.holds(0.04, other), apart < 0.04) << i;
      close += apart < 0.04 ? 1 : 0;
      EXPECT_TRUE(i > 0 || apart < 1e-9) << apart;
    }
  }
  EXPECT_GT(close, 10 * (GetParam() - 1));
  EXPECT_LT(close, 190 * (GetParam() - 1));
}

INSTANTIATE_TEST_SUITE_P(Order, AxisBesideTheCentreTest, testing::Values(2, 3, 5));

// Symmetries that are known to some millimetres do not leave one point in place.
TEST(PoseDistanceTest, BelowAgreesWithTheDistanceForRoughSymmetries) {
  ReferenceObject object = objectWith({});
  object.symmetries = turnsAbout({0.0, 0.0, 1.0}, {17.0, 1.0, 2.0}, 3);
  object.symmetries.discrete[0].translation_mm += glm::dvec3(3.0, -5.0, 4.0);
  const PoseDistance distance(object);
  for (const Pose& symmetric : object.symmetries.discrete) {
    for (int i = 0; i < 200; ++i) {
      Pose other = kSomewhere * symmetric;
      other.translation_mm += 0.1 * i * glm::dvec3(0.6, -0.8, 0.0);
      EXPECT_EQ(distance.below(0.04, other, kSomewhere), distance(other, kSomewhere) < 0.04) << i;
    }
    EXPECT_TRUE(distance.below(0.04, kSomewhere * symmetric, kSomewhere));
  }
}

TEST(PoseDistanceTest, OfABallOnlyItsCentreCounts) {
  ReferenceObject object = objectWith({});
  const glm::dvec3 centre(1.0, 2.0, 3.0);  // not that of the sphere that the object has
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 direction = glm::dmat3(1.0)[i];
    object.symmetries.continuous.push_back({direction, centre + 30.0 * (i + 1) * direction});
  }
  const PoseDistance distance(object);
  const glm::dmat3 turn = rotationFromVector({0.3, 1.0, -2.0});
  const Pose other = kSomewhere * Pose{turn, centre - turn * centre};
  EXPECT_NEAR(distance(kSomewhere, other), 0.0, 1e-6);
  EXPECT_TRUE(distance.below(0.01, kSomewhere, other));
}

// Else a duplicate is refined and reported, or a pose of its own is lost.
TEST(PoseDistanceTest, AListHoldsWhatIsLikeAnyOfItsPoses) {
  ReferenceObject object = objectWith({});
  object.symmetries.discrete = {turned(object, {0.0, kPi, 0.0})};
  const PoseDistance distance(object);
  PoseList list(object);
  EXPECT_FALSE(list.holds(10.0, kSomewhere));
  std::vector<Pose> poses;
  int held = 0;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.1 * (i * 37 % 101);
    Pose pose = kSomewhere * turned(object, {0.3 * t, t, -0.1 * t});
    pose.translation_mm += glm::dvec3(t, -0.5 * t, 0.7 * t);
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const Pose& other) {
      return distance(other, pose) < 0.08;
    });
    EXPECT_EQ(list.holds(0.08, pose), known) << i;
    held += known ? 1 : 0;
    if (known) continue;
    poses.push_back(pose);
    list.add(pose);
  }
  EXPECT_GT(held, 199) << "the poses repeat";
  EXPECT_LT(held, 300);
  EXPECT_GT(poses.size(), 10U);
}

}  // namespace
}  // namespace rangepose
