// Parts that are hard for the method: what still holds for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/solids.h"
#include "support/box_mesh.h"
#include "support/judged_scene.h"
#include "support/model_parts.h"

namespace rangepose {
namespace {

using test::Judged;

constexpr double kHalfTurn = std::numbers::pi;

PlacedPart placed(const glm::dvec3& rotation_vector, const glm::dvec3& translation) {
  PlacedPart part;
  part.world_from_object = {rotationFromVector(rotation_vector), translation};
  return part;
}

/// The parts on a table, by a structured-light sensor 650 mm away; all that is found of them.
Judged searched(const ReferenceDatabase& database,
                const std::vector<PlacedPart>& parts,
                const ScannerOptions& options = {}) {
  const Mesh& mesh = database.objects.front().mesh;
  const Scan scan = scanHeap({mesh}, parts, options);
  const Judged judged = test::judge(test::estimateAll(scan.image, database), scan, database, {0});
  std::cout << "  " << mesh.name << ": " << judged << "\n";
  return judged;
}

Judged searched(const Mesh& mesh, const std::vector<PlacedPart>& parts) {
  return searched(test::databaseOfMeshes({mesh}), parts);
}

/// Four parts: place(k) says where part k lies.
template <typename Place>
std::vector<PlacedPart> rowOfFour(const Place& place) {
  std::vector<PlacedPart> row(4);
  for (int k = 0; k < 4; ++k) row[static_cast<std::size_t>(k)] = placed({}, place(k));
  return row;
}

/// 80 x 50 mm with a corner cut off and a hole beside the middle.
Mesh plate(double thickness_mm) {
  const auto box = [&](double x0, double y0, double x1, double y1) {
    return test::Box{{x0, y0, 0.0}, {x1, y1, thickness_mm}};
  };
  Mesh mesh = test::meshOf(
      {box(0, 0, 80, 16), box(0, 16, 20, 34), box(38, 16, 80, 34), box(0, 34, 58, 50)});
  mesh.name = std::to_string(thickness_mm) + " mm thick";
  return mesh;
}

class FlatPlateTest : public testing::TestWithParam<double> {};

TEST_P(FlatPlateTest, OnAFlatTableEitherSideUp) {
  const double thickness_mm = GetParam();
  const Judged judged = searched(plate(thickness_mm),
                                 {placed({0.0, 0.0, 0.4}, {-90.0, -40.0, 0.0}),
                                  placed({0.0, 0.0, 2.2}, {80.0, 20.0, 0.0}),
                                  placed({kHalfTurn, 0.0, 0.0}, {-20.0, -10.0, thickness_mm})});
  EXPECT_GE(judged.right, 2);
  EXPECT_EQ(judged.wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Thickness,
                         FlatPlateTest,
                         testing::Values(8.0, 3.0, 2.0),
                         [](const auto& mm) {
                           return std::to_string(static_cast<int>(mm.param)) + "mm";
                         });

TEST(FlatPlateTest, ThinnerThanTheNoiseAllowsIsNotFoundAndNothingElseIs) {
  const Judged judged = searched(plate(0.5), {placed({0.0, 0.0, 0.4}, {-40.0, -20.0, 0.0})});
  EXPECT_EQ(judged.right + judged.wrong, 0);
}

Mesh rod(double radius_mm, double length_mm) {
  constexpr unsigned kSides = 32;
  Mesh mesh;
  mesh.name = "rod of " + std::to_string(2.0 * radius_mm) + " mm";
  for (const double z : {0.0, length_mm}) {
    for (unsigned k = 0; k < kSides; ++k) {
      const double turn = 2.0 * kHalfTurn * k / kSides;
      mesh.vertices.emplace_back(radius_mm * std::cos(turn), radius_mm * std::sin(turn), z);
    }
  }
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  mesh.vertices.emplace_back(0.0, 0.0, length_mm);
  for (unsigned k = 0; k < kSides; ++k) {
    const unsigned next = (k + 1) % kSides;
    mesh.triangles.emplace_back(k, next, kSides + k);
    mesh.triangles.emplace_back(next, kSides + next, kSides + k);
    mesh.triangles.emplace_back(2 * kSides, next, k);
    mesh.triangles.emplace_back(2 * kSides + 1, kSides + k, kSides + next);
  }
  return mesh;
}

class ThinRodTest : public testing::TestWithParam<double> {};

TEST_P(ThinRodTest, LiesOnATableOrLeans) {
  const double r = GetParam();
  const Judged judged = searched(rod(r, 100.0),
                                 {placed({0.5 * kHalfTurn, 0.0, 0.0}, {-60.0, 50.0, r}),
                                  placed({0.0, 0.5 * kHalfTurn, 0.0}, {-20.0, -30.0, r}),
                                  placed({0.0, 0.4 * kHalfTurn, 0.0}, {-20.0, 40.0, r + 1.0})});
  EXPECT_GE(judged.right, 2);
  EXPECT_LE(judged.wrong, 1) << "one that has slipped along its axis";
}

INSTANTIATE_TEST_SUITE_P(Radius, ThinRodTest, testing::Values(6.0, 4.0, 2.5), [](const auto& mm) {
  return std::to_string(static_cast<int>(10.0 * mm.param)) + "tenths";
});

TEST(TouchingTest, BlocksFlushInARowAreNotMistaken) {
  Mesh mesh = test::meshOf({{{0.0, 0.0, 0.0}, {60.0, 40.0, 30.0}}});
  mesh.name = "flush blocks";
  const Judged judged =
      searched(mesh, rowOfFour([](int k) { return glm::dvec3(-30.0, -80.0 + 40.0 * k, 0.0); }));
  EXPECT_LE(judged.wrong, 1);
  EXPECT_LT(judged.best_wrong, test::kSure) << "over a seam that nobody can see";
}

TEST(TouchingTest, BlocksThatDoNotLieFlushAreFoundInPart) {
  Mesh mesh = test::meshOf({{{0.0, 0.0, 0.0}, {60.0, 40.0, 30.0}}});
  mesh.name = "staggered blocks";
  const Judged judged =
      searched(mesh, rowOfFour([](int k) {
                 return glm::dvec3(-30.0 + 7.0 * (k % 2), -80.0 + 40.0 * k, 3.0 * (k % 3));
               }));
  EXPECT_GE(judged.right, 2);
  EXPECT_LE(judged.wrong, 1);
  EXPECT_LT(judged.best_wrong, test::kSure);
}

/// Their faces are one plane over the seams, where nothing tells one bracket's end from the next
/// one's beginning.
TEST(TouchingTest, BracketsFaceToFaceAreFoundInPart) {
  constexpr double kWidthMm = 64.0;  // along y
  const Judged judged =
      searched(test::modelMesh("bracket"),
               rowOfFour([](int k) { return glm::dvec3(0.0, kWidthMm * (k - 1.5), 0.0); }));
  EXPECT_GE(judged.right, 2);
  EXPECT_EQ(judged.wrong, 0);
}

/// The same after half a turn about any of its axes but for a boss of 2 mm on one face, z upwards
/// there.
Mesh blockWithBoss() {
  Mesh mesh = test::meshOf({{{-37.0, -13.0, 0.0}, {37.0, 13.0, 18.0}},
                            {{-20.0, -20.0, 4.0}, {-8.0, 20.0, 14.0}},
                            {{8.0, -20.0, 4.0}, {20.0, 20.0, 14.0}},
                            {{22.0, -7.0, 18.0}, {34.0, 7.0, 20.0}}});
  mesh.name = "block with a boss";
  return mesh;
}

/// A score that a pose whose rival is as likely does not have.
constexpr double kNoTie = 0.75;

TEST(NearlySymmetricTest, LiesTheRightWayRoundWhereThatIsSeen) {
  const Judged judged = searched(
      blockWithBoss(),
      {placed({0.0, 0.0, 0.4}, {-70.0, 0.0, 0.0}), placed({0.0, 0.0, 2.6}, {70.0, 0.0, 0.0})});
  EXPECT_EQ(judged.right, 2);
  EXPECT_EQ(judged.wrong, 0);
  EXPECT_GT(judged.least_right, kNoTie);
}

TEST(NearlySymmetricTest, NothingIsClaimedWhereItIsNot) {
  // On its boss: of the two poses that are left either may be the one.
  const ReferenceDatabase database = test::databaseOfMeshes({blockWithBoss()});
  ASSERT_EQ(database.objects[0].twins.size(), 3U);
  // Noise in a pixel or two makes either surer now and then: hence several scans.
  int sure = 0;
  constexpr int kScans = 6;
  for (int i = 0; i < kScans; ++i) {
    ScannerOptions scanner;
    scanner.seed = static_cast<std::uint64_t>(i + 1);
    const Judged judged = searched(database,
                                   {placed({kHalfTurn, 0.0, 0.0}, {-60.0, 0.0, 20.0}),
                                    placed({kHalfTurn, 0.0, 0.0}, {60.0, 30.0, 20.0})},
                                   scanner);
    sure += judged.best_wrong >= kNoTie ? 1 : 0;
    sure += judged.right > 0 && judged.least_right >= kNoTie ? 1 : 0;  // by chance
  }
  EXPECT_LE(sure, kScans / 2) << "of 12 parts: a robot would rely on it";
}

/// A round plate with `ears` ears and a hub on one side: it looks the same after each `ears`-th of
/// a turn, about an axis that is not amid its bounding box.
Mesh flange(int ears) {
  constexpr double kPlateMm = 24.0;  // radius
  constexpr double kAtMm = 28.0;     // the centre of an ear
  constexpr double kEarMm = 8.0;     // radius
  std::vector<glm::dvec2> outline;
  for (const glm::dvec2& along : test::regularPolygon(40 * ears, 1.0)) {
    // Where the ray leaves the nearest ear, if it meets that.
    const double turn = 2.0 * kHalfTurn / ears;
    const double angle = std::remainder(std::atan2(along.y, along.x), turn);
    const double beside = kAtMm * std::sin(angle);
    const double rest = kEarMm * kEarMm - beside * beside;
    const double ear = rest > 0.0 ? kAtMm * std::cos(angle) + std::sqrt(rest) : 0.0;
    outline.push_back(std::max(kPlateMm, ear) * along);
  }
  Mesh mesh;
  mesh.name = "flange with " + std::to_string(ears) + " ears";
  test::addPrism(mesh, outline, 0.0, 6.0);
  test::addPrism(mesh, test::regularPolygon(40 * ears, 12.0), 6.0, 18.0);
  return mesh;
}

class EaredFlangeTest : public testing::TestWithParam<int> {};

// Its symmetric copies are no rivals: with three of them each would get a third of the odds.
TEST_P(EaredFlangeTest, AloneOnATableIsSure) {
  const ReferenceDatabase flanges = test::databaseOfMeshes({flange(GetParam())});
  ASSERT_EQ(symmetryName(flanges.objects.front().symmetries), "C" + std::to_string(GetParam()));
  for (const double turn : {0.2, 1.3}) {
    const Judged judged = searched(flanges, {placed({0.0, 0.0, turn}, {10.0, -20.0, 0.0})});
    EXPECT_EQ(judged.right, 1);
    EXPECT_EQ(judged.wrong, 0);
    EXPECT_GT(judged.least_right, test::kSure);
  }
}

INSTANTIATE_TEST_SUITE_P(Ears, EaredFlangeTest, testing::Values(3, 5));

/// Only the corners of the head tell how the bolt is turned, and nothing but the head or the end
/// face is seen.
TEST(BoltTest, SeenEndOnFromEitherEnd) {
  const ReferenceDatabase bolts = test::databaseOfMeshes({test::modelMesh("bolt")});
  int right = 0;
  int wrong = 0;
  for (const double turn : {0.0, 0.1, kHalfTurn, kHalfTurn + 0.1}) {
    ScannerOptions straight_down;
    straight_down.tilt_rad = 0.0;
    const Judged judged =
        searched(bolts, {placed({turn, 0.0, 0.0}, {20.0, 10.0, 60.0})}, straight_down);
    right += judged.right;
    wrong += judged.wrong;
  }
  EXPECT_GE(right, 3) << "of 4";
  EXPECT_LE(wrong, 1);
}

}  // namespace
}  // namespace rangepose
