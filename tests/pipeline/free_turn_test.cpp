// Where the seen side of a part leaves it free to turn, the search may rest anywhere: without these
// copies a part is reported as sure that is turned by any angle.
#include "pipeline/free_turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

constexpr double kToleranceMm = 1.5;
constexpr double kRodMm = 15.0;

/// A rod along x, 60 mm long, with a peg that stands out to -z.
Mesh pegRod() {
  constexpr unsigned kSides = 96;
  Mesh mesh;
  test::addBox(mesh, {{-4.0, -4.0, -30.0}, {4.0, 4.0, -10.0}});
  const auto first = static_cast<unsigned>(mesh.vertices.size());
  for (unsigned k = 0; k < kSides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSides;
    for (const double x : {-30.0, 30.0})
      mesh.vertices.emplace_back(x, kRodMm * std::cos(angle), kRodMm * std::sin(angle));
  }
  for (unsigned k = 0; k < kSides; ++k) {
    const unsigned a = first + 2 * k;
    const unsigned b = first + 2 * ((k + 1) % kSides);
    mesh.triangles.emplace_back(a, b, a + 1);
    mesh.triangles.emplace_back(a + 1, b, b + 1);
  }
  return mesh;
}

struct Scene {
  ReferenceObject object;
  DepthImage image;
  Candidate candidate;

  Scene(const Mesh& mesh, const glm::dmat3& rotation) {
    object.mesh = mesh;
    object.diameter_mm = diameter(mesh);
    image.camera = test::pinholeCamera(320, 240, 400.0);
    candidate.pose = {rotation, {12.0, -7.0, 400.0}};
    test::measure(image, mesh, candidate.pose);
  }
  std::optional<FreeTurn> freest() const {
    const SurfaceWindow window = test::wholeWindow(image.camera);
    return freestTurn(host::renderSurface(object.mesh, image.camera, candidate.pose, window),
                      window,
                      image,
                      object,
                      candidate.pose,
                      kToleranceMm);
  }
};

/// The camera looks along z of the part, and the peg is behind the rod.
const glm::dmat3 kPegBehind = rotationFromVector({std::numbers::pi, 0.0, 0.0});

TEST(FreeTurnTest, ARodWithItsPegBehindTurnsAboutItsAxis) {
  const Scene scene(pegRod(), rotationFromVector({0.0, 0.3, 0.2}) * kPegBehind);
  const std::optional<FreeTurn> turn = scene.freest();
  ASSERT_TRUE(turn.has_value());
  const glm::dvec3 axis = scene.candidate.pose.rotation[0];
  EXPECT_NEAR(std::abs(glm::dot(turn->axis, axis)), 1.0, 1e-4);
  const glm::dvec3 off = turn->on_axis_mm - scene.candidate.pose.translation_mm;
  EXPECT_LT(glm::length(glm::cross(off, axis)), 0.3) << "[mm] beside the axis";
  EXPECT_LT(turn->change_mm, 0.1 * kToleranceMm);
}

TEST(FreeTurnTest, AFlankOfThePegInSightHoldsTheRod) {
  const Scene behind(pegRod(), rotationFromVector({0.0, 0.3, 0.2}) * kPegBehind);
  const Scene before(pegRod(), rotationFromVector({0.7, 0.3, 0.2}));
  ASSERT_TRUE(before.freest().has_value());
  EXPECT_GT(before.freest()->change_mm, 3.0 * behind.freest()->change_mm);
}

TEST(FreeTurnTest, ABlockSeenAtACornerIsHeld) {
  const Scene scene(test::meshOf({{{-30.0, -20.0, -15.0}, {30.0, 20.0, 15.0}}}),
                    rotationFromVector({0.7, 0.5, 0.2}));
  ASSERT_TRUE(scene.freest().has_value());
  EXPECT_GT(scene.freest()->change_mm, 0.5 * kToleranceMm);
}

TEST(FreeTurnTest, WhereNothingIsSeenThereIsNone) {
  Scene scene(pegRod(), kPegBehind);
  for (float& depth : scene.image.depth_mm) depth = depth > 0.0f ? depth + 50.0f : 0.0f;
  EXPECT_FALSE(scene.freest().has_value());
}

TEST(FreeTurnTest, CopiesGoAllTheWayRoundAndLeaveWhatIsSeen) {
  const Scene scene(pegRod(), rotationFromVector({0.0, 0.3, 0.2}) * kPegBehind);
  constexpr int kSteps = 24;
  const std::vector<Candidate> copies = turnedAbout(*scene.freest(), scene.candidate, kSteps);
  ASSERT_EQ(copies.size(), kSteps - 1U);
  const Pose& pose = scene.candidate.pose;
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i + 1) / kSteps;
    EXPECT_NEAR(rotationAngleBetween(copies[i].pose.rotation, pose.rotation),
                std::min(angle, 2.0 * std::numbers::pi - angle),
                1e-6);
    for (const double x : {-30.0, 30.0}) {
      const glm::dvec3 on_axis(x, 0.0, 0.0);
      EXPECT_LT(glm::distance(copies[i].pose * on_axis, pose * on_axis), 1.0);
    }
  }
}

}  // namespace
}  // namespace rangepose
