// Twins of parts that are known by how they are made: a twin that is missing leaves a pose without
// its rival, and a part is handed over upside down as if that were sure.
#include "geometry/twins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "geometry/solids.h"
#include "support/box_mesh.h"

namespace rangepose {
namespace {

using test::Box;
using test::meshOf;

constexpr double kPi = std::numbers::pi;

std::vector<Pose> twinsOf(const Mesh& mesh) { return findTwins(mesh, findSymmetries(mesh)); }

/// A block about the origin, and a boss on its upper face, off its middle.
std::vector<Box> blockWithBoss(double height_mm) {
  return {{{-40.0, -15.0, -10.0}, {40.0, 15.0, 10.0}},
          {{6.0, -8.0, 10.0}, {20.0, 4.0, 10.0 + height_mm}}};
}

/// Whether one of them is that half turn about the origin.
bool holdsHalfTurn(const std::vector<Pose>& twins, const glm::dvec3& axis) {
  return std::any_of(twins.begin(), twins.end(), [&](const Pose& twin) {
    return rotationAngleBetween(twin.rotation, rotationFromVector(kPi * axis)) < 1e-3 &&
           glm::length(twin.translation_mm) < 0.05;
  });
}

TEST(TwinsTest, ABlockWithABossHasItsHalfTurnsExactly) {
  const std::vector<Pose> twins = twinsOf(meshOf(blockWithBoss(3.0)));
  EXPECT_EQ(twins.size(), 3U);
  for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
    EXPECT_TRUE(holdsHalfTurn(twins, axis))
        << axis.x << axis.y << axis.z << ": pulled off by the boss";
}

TEST(TwinsTest, TheyMoveWithThePart) {
  const Pose place{rotationFromVector({0.4, -1.1, 0.7}), {50.0, 20.0, -30.0}};
  const Mesh mesh = test::moved(meshOf(blockWithBoss(3.0)), place);
  std::vector<Pose> twins = twinsOf(mesh);
  for (Pose& twin : twins) twin = place.inverse() * twin * place;
  EXPECT_EQ(twins.size(), 3U);
  EXPECT_TRUE(holdsHalfTurn(twins, {1.0, 0.0, 0.0}));
}

TEST(TwinsTest, SymmetriesAreNone) {
  EXPECT_TRUE(twinsOf(meshOf({{{0, 0, 0}, {40, 25, 12}}})).empty());
  EXPECT_TRUE(twinsOf(test::prism(6, 10.0, 14.0)).empty());
}

TEST(TwinsTest, ABoltWhoseHeadIsTurnedBetweenItsCornersIsNoSymmetricCopy) {
  // Its shank is most of it.
  const Mesh mesh = test::boltMesh(0.0);
  const Symmetries symmetries = findSymmetries(mesh);
  for (const Pose& twin : findTwins(mesh, symmetries)) {
    EXPECT_GT(rotationAngleModulo(symmetries, twin.rotation, glm::dmat3(1.0)), 10.0 * kPi / 180.0)
        << "a pose would compete with itself";
  }
}

TEST(TwinsTest, OfThoseThatDifferByASymmetryOneIsEnough) {
  // A plus sign with a boss through one arm: a half turn about that arm leaves it the same, so that
  // the two twins that look at it from either side are one.
  const Mesh mesh = meshOf({{{-40, -8, -5}, {40, 8, 5}},
                            {{-8, 8, -5}, {8, 40, 5}},
                            {{-8, -40, -5}, {8, -8, 5}},
                            {{20, -4, 5}, {30, 4, 8}},
                            {{20, -4, -8}, {30, 4, -5}}});
  ASSERT_EQ(findSymmetries(mesh).discrete.size(), 1U);
  EXPECT_EQ(twinsOf(mesh).size(), 3U) << "for each of the other arms";
}

TEST(TwinsTest, APartUnlikeItselfHasNone) {
  EXPECT_TRUE(twinsOf(meshOf(test::bracketBoxes())).empty());
}

TEST(TwinsTest, ALargeBossIsNoDetail) {
  EXPECT_TRUE(twinsOf(meshOf(blockWithBoss(3.0))).size() == 3U);
  const std::vector<Box> tower{{{-40, -15, -10}, {40, 15, 10}}, {{0, -15, 10}, {40, 15, 60}}};
  EXPECT_TRUE(twinsOf(meshOf(tower)).empty());
}

TEST(TwinsTest, RefusesBadOptions) {
  const Mesh mesh = meshOf(blockWithBoss(3.0));
  TwinOptions options;
  options.least_share = 0.0;
  EXPECT_THROW(findTwins(mesh, {}, options), Error);
  options = {};
  options.tolerance = std::nan("");
  EXPECT_THROW(findTwins(mesh, {}, options), Error);
}

}  // namespace
}  // namespace rangepose
