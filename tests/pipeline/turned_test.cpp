// Poses that show nearly the same as one that was found: without them a part that is turned the
// wrong way is reported as sure, for nothing competes with it.
#include "pipeline/turned.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/explained_pixels.h"
#include "pipeline/scene_window.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

/// A bar that lies across the view, and the pixels that it explains.
struct BarScene {
  ReferenceObject object = test::objectOf({{{0.0, 0.0, 0.0}, {45.0, 7.0, 5.0}}}, 40, 64, 3);
  DepthImage image;
  Candidate candidate;
  std::vector<std::int32_t> pixels;

  BarScene() {
    image.camera = test::pinholeCamera(320, 240, 400.0);
    candidate.pose = {rotationFromVector({0.2, 0.1, 0.6}), {10.0, -5.0, 400.0}};
    test::measure(image, object.mesh, candidate.pose);
    const SurfaceWindow window =
        windowAround(image.camera, candidate.pose * object.center_mm, object.radius_mm, 1 << 20);
    pixels = explainedPixels(
        host::renderSurface(object.mesh, image.camera, candidate.pose, window), window, image, 1.0);
  }
  std::vector<Candidate> copies() const {
    return turnedCopies(candidate, pixels, image, object, areaMoments(object.mesh));
  }
  glm::dvec3 axis() const { return candidate.pose.rotation[0]; }
};

double angleOf(const glm::dmat3& turn) {
  const double cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

TEST(TurnedTest, EighthsAboutTheLengthAndQuartersAcrossAndHalvesAboutThePartsOwnAxes) {
  const BarScene scene;
  std::vector<double> along;
  std::vector<double> across;
  for (const Candidate& copy : scene.copies()) {
    const glm::dmat3 turn = copy.pose.rotation * glm::transpose(scene.candidate.pose.rotation);
    const double kept = glm::dot(turn * scene.axis(), scene.axis());
    // What is seen of the bar leans a little against it.
    (kept > 0.99 ? along : across).push_back(std::round(angleOf(turn)));
  }
  EXPECT_THAT(along, testing::UnorderedElementsAre(45, 90, 135, 180, 135, 90, 45, 180));
  EXPECT_THAT(across, testing::UnorderedElementsAre(90, 180, 90, 90, 180, 90, 180, 180));
}

TEST(TurnedTest, HalfTurnsAboutThePartsOwnAxesLayItOnItselfHoweverLittleIsSeenOfIt) {
  BarScene scene;
  scene.pixels.resize(scene.pixels.size() / 4);
  int same = 0;
  for (const Candidate& copy : scene.copies()) {
    const Pose change = scene.candidate.pose.inverse() * copy.pose;
    const bool half_turn = std::abs(angleOf(change.rotation) - 180.0) < 1e-3;
    const glm::dvec3& middle = scene.object.center_mm;
    if (half_turn && glm::distance(change * middle, middle) < 0.1) ++same;
  }
  EXPECT_EQ(same, 3) << "the wrong way round would have no rival";
}

TEST(TurnedTest, CopiesStayOnWhatIsSeen) {
  const BarScene scene;
  glm::dvec3 seen(0.0);
  for (const std::int32_t at : scene.pixels) {
    const int u = at % 320;
    const int v = at / 320;
    seen += scene.image.camera.unproject(u, v, static_cast<double>(scene.image.depth_mm.at(u, v)));
  }
  seen /= static_cast<double>(scene.pixels.size());
  const glm::dvec3 on_part = scene.candidate.pose.inverse() * seen;
  const std::vector<Candidate> copies = scene.copies();
  const auto stays = [&](const Candidate& copy) {
    return glm::distance(copy.pose * on_part, seen) < 1e-9;
  };
  EXPECT_EQ(std::count_if(copies.begin(), copies.end(), stays), 13)
      << "all but those about the part's own axes";
}

TEST(TurnedTest, EachHasTheViewThatLooksAtItAsTheCameraDoes) {
  const BarScene scene;
  for (const Candidate& copy : scene.copies()) {
    const glm::dvec3 ray = glm::normalize(copy.pose * scene.object.center_mm);
    const auto cosine = [&](const ReferenceView& view) {
      return glm::dot(copy.pose.rotation * glm::transpose(view.rotation)[2], ray);
    };
    const double chosen = cosine(scene.object.views[static_cast<std::size_t>(copy.view)]);
    for (const ReferenceView& view : scene.object.views) EXPECT_LE(cosine(view), chosen + 1e-12);
  }
}

TEST(TurnedTest, NothingExplainedNothingTurned) {
  const BarScene scene;
  EXPECT_TRUE(
      turnedCopies(scene.candidate, {}, scene.image, scene.object, areaMoments(scene.object.mesh))
          .empty());
}

}  // namespace
}  // namespace rangepose
