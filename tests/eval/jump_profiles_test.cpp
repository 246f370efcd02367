// What becomes of jumps of depth, and what is lost.
#include "eval/jump_profiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eval/lost_pixels.h"
#include "eval/scan_scene.h"
#include "eval/scan_statistics.h"

namespace rangepose {
namespace {

using test::BlockOnFloor;

constexpr auto kLeft = static_cast<std::size_t>(ContourSide::kLeft);

ScanStatistics measured(const DepthImage& image, const std::vector<KnownPart>& parts) {
  return statisticsOf(tallyScan(image, parts));
}

ScanStatistics ofBlock(const std::function<double(const glm::dvec2& px)>& depth) {
  const BlockOnFloor block;
  return measured(BlockOnFloor::scan(depth), {block.part()});
}

double depthAt(const ScanStatistics& figures, int place_px) {
  const auto place = std::find(kProfilePlacesPx.begin(), kProfilePlacesPx.end(), place_px);
  return figures.places.at(static_cast<std::size_t>(place - kProfilePlacesPx.begin())).depth;
}

TEST(JumpProfiles, SharpJumpIsWhereTheContourIs) {
  const ScanStatistics figures = ofBlock(BlockOnFloor::ideal);
  EXPECT_GT(figures.profiles, 280) << "of 320 pixels along the contour, but for its corners";
  EXPECT_EQ(figures.smear_px, 0.0);
  EXPECT_NEAR(figures.passing_px, 0.0, 0.25);
  EXPECT_LT(figures.passing_spread_px, 0.4);
  EXPECT_EQ(depthAt(figures, -1), 0.0);
  EXPECT_EQ(depthAt(figures, 1), 1.0);
  for (const JumpSideFigures& side : figures.sides) {
    EXPECT_GT(side.profiles, 70);
    EXPECT_NEAR(side.passing_px, 0.0, 0.25);
    EXPECT_EQ(side.hole_px, 0.0);
  }
}

TEST(JumpProfiles, SmearIsAsWideAsItIs) {
  for (const double wide : {4.0, 8.0}) {
    const ScanStatistics figures = ofBlock([wide](const glm::dvec2& px) {
      const double share = std::clamp(BlockOnFloor::outside(px) / wide + 0.5, 0.0, 1.0);
      return BlockOnFloor::kTopMm + share * (BlockOnFloor::kFloorMm - BlockOnFloor::kTopMm);
    });
    EXPECT_GT(figures.profiles, 280);
    EXPECT_NEAR(figures.smear_px, 0.7 * wide, 0.5) << "70 % of the jump";
    EXPECT_NEAR(figures.passing_px, 0.0, 0.15);
    EXPECT_NEAR(depthAt(figures, 1), 0.5 + 1.0 / wide, 0.5 / wide);
  }
}

TEST(JumpProfiles, FatterPartsArePassedOutside) {
  for (const double fatter : {-2.0, 3.0}) {
    const ScanStatistics figures = ofBlock([fatter](const glm::dvec2& px) {
      return BlockOnFloor::outside(px) < fatter ? BlockOnFloor::kTopMm : BlockOnFloor::kFloorMm;
    });
    EXPECT_NEAR(figures.passing_px, fatter, 0.25);
    EXPECT_LT(figures.smear_px, 0.1);
  }
}

TEST(JumpProfiles, FloorThatFallsAwayIsNoSmear) {
  const ScanStatistics figures = ofBlock([](const glm::dvec2& px) {
    return BlockOnFloor::ideal(px) + 1.5 * std::max(0.0, BlockOnFloor::outside(px));
  });
  EXPECT_GT(figures.profiles, 200);
  EXPECT_LT(figures.smear_px, 0.1) << "at the contour the floor is 77 % of what it is farther off";
}

TEST(JumpProfiles, HolesAreOnTheirSide) {
  constexpr double kHole = 5.0;
  const ScanStatistics figures = ofBlock([](const glm::dvec2& px) {
    const glm::dvec2 along = BlockOnFloor::along(px);
    const double left = -along.x - BlockOnFloor::kHalfPx;
    const bool hole = left >= 0.0 && left < kHole && std::abs(along.y) < BlockOnFloor::kHalfPx;
    return hole ? 0.0 : BlockOnFloor::ideal(px);
  });
  for (std::size_t side = 0; side < figures.sides.size(); ++side) {
    EXPECT_GT(figures.sides[side].profiles, 70);
    EXPECT_NEAR(figures.sides[side].hole_px, side == kLeft ? kHole : 0.0, 0.3) << side;
    EXPECT_NEAR(figures.sides[side].wide_share, side == kLeft ? 1.0 : 0.0, 0.05) << side;
  }
  const long long others =
      figures.sides[1].profiles + figures.sides[2].profiles + figures.sides[3].profiles;
  EXPECT_NEAR(static_cast<double>(figures.profiles), static_cast<double>(others), 6.0)
      << "where holes are wide nobody knows where the jump is";
}

TEST(JumpProfiles, FarHolesAndLowStepsDoNotCount) {
  const ScanStatistics far = ofBlock([](const glm::dvec2& px) {
    const double outside = BlockOnFloor::outside(px);
    return outside > 9.0 && outside < 12.0 ? 0.0 : BlockOnFloor::ideal(px);
  });
  EXPECT_GT(far.sides[kLeft].profiles, 70);
  EXPECT_EQ(far.sides[kLeft].hole_px, 0.0);
  const ScanStatistics low = ofBlock([](const glm::dvec2& px) {
    return BlockOnFloor::kTopMm + (BlockOnFloor::outside(px) < 0.0 ? 0.0 : 14.0);
  });
  EXPECT_EQ(low.profiles, 0);
  const ScanStatistics nothing = ofBlock([](const glm::dvec2& px) {
    return BlockOnFloor::outside(px) < 0.0 ? BlockOnFloor::kTopMm : 0.0;
  });
  EXPECT_EQ(nothing.sides[kLeft].profiles, 0) << "nothing is known to lie behind";
}

TEST(JumpProfiles, NoJumpIsTakenTowardsAPartBeside) {
  const BlockOnFloor block;
  KnownPart beside = block.part();
  beside.camera_from_object.translation_mm.x -= 115.0;
  const DepthImage image = BlockOnFloor::scan(BlockOnFloor::ideal);
  const auto leftProfiles = [&image](const std::vector<KnownPart>& parts) {
    const KnownSurface known = renderKnown(parts, image.camera);
    const std::vector<JumpProfile> profiles = jumpProfiles(image, known, parts);
    return std::count_if(profiles.begin(), profiles.end(), [](const JumpProfile& profile) {
      EXPECT_EQ(profile.part, 0) << "the data does not show the other";
      return profile.side() == ContourSide::kLeft;
    });
  };
  EXPECT_GT(leftProfiles({block.part()}), 70);
  EXPECT_LT(leftProfiles({block.part(), beside}), 25) << "but for the corners";
}

TEST(KnownSurface, InnerPixelsKeepOffContoursAndJumpsButNotCreases) {
  // Two steps of a stair, 90 pixels wide together, the lower one with a slope beside it.
  Mesh mesh = test::meshOf(
      {{{-60.0, -40.0, 0.0}, {0.0, 40.0, 40.0}}, {{0.0, -40.0, 20.0}, {60.0, 40.0, 40.0}}});
  KnownPart part{&mesh, diameter(mesh), {}, true};
  part.camera_from_object.translation_mm.z = 500.0;
  const Camera camera = test::scanCamera();
  const KnownSurface known = renderKnown({part}, camera);
  const int row = 120;
  const auto inner = [&](int u) { return known.at(u, row).inner(); };
  int first = 0;
  while (known.at(first, row).part < 0) ++first;
  EXPECT_FALSE(inner(first));
  EXPECT_FALSE(inner(first + 2));
  EXPECT_TRUE(inner(first + 3));
  EXPECT_EQ(known.at(first + 12, row).inside_px, 12);
  int step = first;
  while (known.at(step + 1, row).depth_mm < 510.0f) ++step;
  EXPECT_TRUE(inner(step - 3));
  EXPECT_FALSE(inner(step - 2));
  EXPECT_FALSE(inner(step + 3));
  EXPECT_TRUE(inner(step + 4));
  // A roof: its crease is no jump.
  Mesh roof;
  roof.vertices = {
      {-60, -40, 30}, {-60, 40, 30}, {0, -40, 0}, {0, 40, 0}, {60, -40, 30}, {60, 40, 30}};
  roof.triangles = {{0, 3, 1}, {0, 2, 3}, {2, 5, 3}, {2, 4, 5}};
  part.mesh = &roof;
  EXPECT_TRUE(renderKnown({part}, camera).at(160, row).inner());
}

TEST(LostPixels, OfSteepSurfaceOnly) {
  const Mesh ball = test::sphereMesh({0.0, 0.0, 0.0}, 60.0, 60);
  KnownPart part{&ball, 120.0, {}, true};
  part.camera_from_object.translation_mm.z = 500.0;
  DepthImage image;
  image.camera = test::scanCamera();
  test::measure(image, ball, part.camera_from_object);
  const KnownSurface known = renderKnown({part}, image.camera);
  int all = 0;
  int lost = 0;
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      if (known.at(u, v).part < 0) continue;
      ++all;
      if (known.at(u, v).cosine >= 0.5f) continue;
      ++lost;
      image.depth_mm.at(u, v) = 0.0f;
    }
  }
  const ScanStatistics figures = measured(image, {part});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(figures.lost_by_slant[i], 0.0) << i;
  EXPECT_EQ(figures.lost_by_slant[4], 1.0);
  EXPECT_DOUBLE_EQ(figures.lost_share, static_cast<double>(lost) / all);
}

TEST(LostPixels, HiddenSurfaceIsNotLost) {
  const ScanStatistics figures = ofBlock([](const glm::dvec2& px) {
    if (px.x < 0.0) return 400.0;  // something lies over the left half
    return px.y < 0.0 ? 0.0 : BlockOnFloor::ideal(px);
  });
  EXPECT_NEAR(figures.lost_share, 0.5, 0.02);
  EXPECT_NEAR(figures.lost_by_slant[0], 0.5, 0.02);
  EXPECT_TRUE(std::isnan(figures.lost_by_slant[2])) << "nothing is seen by 30 to 45 degrees";
}

}  // namespace
}  // namespace rangepose
