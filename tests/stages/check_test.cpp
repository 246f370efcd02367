// The verdict on a pose: wrong poses must lose against right ones, for each way of being wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stages/check_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

/// A bracket over a floor and the check of a pose of it.
struct Bench {
  Mesh mesh = test::meshOf(test::bracketBoxes());
  Sphere sphere = boundingSphere(mesh);
  Pose truth{test::looking({0.45, 0.75, -0.5}), {5.0, -8.0, 450.0}};
  DepthImage image{test::pinholeCamera(320, 240, 600.0), {}};

  Bench() {
    test::measure(image, mesh, truth);
    test::measure(image, test::plateMesh(2000.0, 2000.0), {glm::dmat3(1.0), {0.0, 0.0, 540.0}});
  }
  CheckResult check(const Pose& pose) const {
    const SurfaceWindow window =
        windowAround(image.camera, pose * sphere.center_mm, sphere.radius_mm, 1000);
    return host::check(
        host::renderSurface(mesh, image.camera, pose, window), window, image, around(pose), {});
  }
  Sphere around(const Pose& pose) const { return {pose * sphere.center_mm, sphere.radius_mm}; }
  CheckResult checkPoints(const Pose& pose, bool with_rim = false) const {
    const SurfaceWindow window =
        windowAround(image.camera, pose * sphere.center_mm, sphere.radius_mm, 1000);
    const Image<SurfaceTexel> surface = host::renderSurface(mesh, image.camera, pose, window);
    std::vector<SurfacePoint> points = pointsOfSurface(surface, image.camera, window, pose, 400);
    if (with_rim) {
      const std::vector<SurfacePoint> rim = rimOfSurface(surface, image.camera, window, pose, 400);
      points.insert(points.end(), rim.begin(), rim.end());
    }
    return host::checkPoints(points, pose, 900.0, image, {});
  }
  Pose moved(const glm::dvec3& shift_mm) const {
    return {truth.rotation, truth.translation_mm + shift_mm};
  }
};

CheckResult checkOf(const Mesh& mesh,
                    const DepthImage& image,
                    const Pose& pose,
                    const SurfaceWindow& window) {
  const Sphere sphere = boundingSphere(mesh);
  return host::check(host::renderSurface(mesh, image.camera, pose, window),
                     window,
                     image,
                     {pose * sphere.center_mm, sphere.radius_mm},
                     {});
}

double sumOfShares(const CheckResult& r) {
  return r.explained + r.contradicted + r.hidden + r.buried + r.missing + r.weak;
}

TEST(CheckTest, ThePerfectPoseScoresNearlyOne) {
  const Bench bench;
  for (const CheckResult& result : {bench.check(bench.truth), bench.checkPoints(bench.truth)}) {
    EXPECT_GT(result.score, 0.95);
    // Slopes measured across a crease belong to neither face.
    EXPECT_GT(result.explained, 0.95);
    EXPECT_LT(result.residual_mm, 0.05);
    EXPECT_NEAR(sumOfShares(result), 1.0, 1e-6);
  }
  EXPECT_GT(bench.check(bench.truth).outline, 0.95);
}

/// Their "normals" are tangents: taken for faces they would speak against any pose.
TEST(CheckTest, PointsOfRimsHaveNoSay) {
  const Bench bench;
  const CheckResult without = bench.checkPoints(bench.truth, false);
  const CheckResult with = bench.checkPoints(bench.truth, true);
  EXPECT_EQ(with.pixels, without.pixels);
  EXPECT_EQ(with.explained, without.explained);
  EXPECT_EQ(with.score, without.score);
}

TEST(CheckTest, ExplainedAreaIsWhatTheCameraSees) {
  // A plate of 60 x 40 mm that faces the camera.
  DepthImage image{test::pinholeCamera(320, 240, 600.0), {}};
  const Mesh plate = test::plateMesh(60.0, 40.0);
  const Pose pose{glm::dmat3(1.0), {0.0, 0.0, 500.0}};
  test::measure(image, plate, pose);
  const SurfaceWindow window = test::wholeWindow(image.camera);
  const CheckResult whole = checkOf(plate, image, pose, window);
  EXPECT_NEAR(whole.explained_mm2, 2400.0, 60.0);
  EXPECT_EQ(whole.outline, 1.0);
  const SurfaceWindow coarse{20, 20, 93, 67, 3};
  const CheckResult third = checkOf(plate, image, pose, coarse);
  EXPECT_NEAR(third.explained_mm2, 2400.0, 180.0) << "the step must not change the area";
  EXPECT_LT(third.pixels * 8, whole.pixels);
}

TEST(CheckTest, SurfaceInFrontOfTheDataIsContradicted) {
  const Bench bench;
  for (const CheckResult& result :
       {bench.check(bench.moved({0, 0, -20})), bench.checkPoints(bench.moved({0, 0, -20}))}) {
    EXPECT_GT(result.contradicted, 0.9);
    EXPECT_LT(result.score, 0.1) << "a gripper would close in the air";
    EXPECT_NEAR(sumOfShares(result), 1.0, 1e-6);
  }
}

TEST(CheckTest, SurfaceWellBehindNearerDataIsHidden) {
  Bench bench;
  test::measure(bench.image, test::plateMesh(500.0, 500.0), {glm::dmat3(1.0), {0.0, 0.0, 380.0}});
  for (const CheckResult& result : {bench.check(bench.truth), bench.checkPoints(bench.truth)}) {
    EXPECT_GT(result.hidden, 0.9);
    EXPECT_EQ(result.explained, 0.0);
    EXPECT_EQ(result.score, 0.0) << "nothing of this part is seen";
    EXPECT_NEAR(sumOfShares(result), 1.0, 1e-6);
  }
}

TEST(CheckTest, SurfaceJustBehindTheDataIsBuried) {
  const Bench bench;
  const CheckResult result = bench.check(bench.moved({0, 0, 7}));
  EXPECT_GT(result.buried, 0.7);
  EXPECT_LT(result.score, 0.2);
  EXPECT_NEAR(sumOfShares(result), 1.0, 1e-6);
}

TEST(CheckTest, SurfaceOverHolesIsMissing) {
  Bench bench;
  for (float& depth : bench.image.depth_mm) depth = depth > 530.0f ? depth : 0.0f;
  for (const CheckResult& result : {bench.check(bench.truth), bench.checkPoints(bench.truth)}) {
    EXPECT_GT(result.missing, 0.99);
    EXPECT_EQ(result.score, 0.0);
    EXPECT_NEAR(sumOfShares(result), 1.0, 1e-6);
  }
}

TEST(CheckTest, EachKindOfFaultCostsScore) {
  const Bench bench;
  const double perfect = bench.check(bench.truth).score;
  const auto spoil = [&](const auto& change) {
    Bench other;
    for (int v = 0; v < 240; ++v) {
      for (int u = 140; u < 175; ++u) {
        float& depth = other.image.depth_mm.at(u, v);
        if (depth < 530.0f) depth = change(depth);
      }
    }
    const CheckResult result = other.check(other.truth);
    EXPECT_NEAR(sumOfShares(result), 1.0, 1e-6);
    return result;
  };
  const CheckResult hole = spoil([](float) { return 0.0f; });
  const CheckResult behind = spoil([](float depth) { return depth + 25.0f; });
  const CheckResult front = spoil([](float depth) { return depth - 25.0f; });
  const CheckResult near = spoil([](float depth) { return depth - 5.0f; });
  const CheckResult off = spoil([](float depth) { return depth + 1.3f; });
  EXPECT_GT(hole.missing, 0.1);
  EXPECT_GT(behind.contradicted, 0.1);
  EXPECT_GT(front.hidden, 0.1);
  EXPECT_GT(near.buried, 0.1);
  EXPECT_GT(off.weak, 0.01);
  for (const CheckResult& result : {hole, behind, front, near, off})
    EXPECT_LT(result.score, perfect - 0.005);
  EXPECT_LT(behind.score, hole.score) << "what the sensor saw through is worse than what it missed";
  EXPECT_LT(near.score, front.score)
      << "what lies in another surface is worse than what is covered";
}

TEST(CheckTest, AWrongSlopeIsNotExplained) {
  // A face on the measured surface, but turned by more than the tilt allowed.
  DepthImage image{test::pinholeCamera(320, 240, 600.0), Image<float>(320, 240, 500.0f)};
  const Mesh plate = test::plateMesh(6.0, 60.0);
  const SurfaceWindow window = test::wholeWindow(image.camera);
  const auto explained = [&](double tilt) {
    const Pose pose{rotationFromVector({0.0, tilt, 0.0}), {0.0, 0.0, 500.0}};
    return checkOf(plate, image, pose, window).explained;
  };
  EXPECT_GT(explained(0.3), 0.9);
  EXPECT_LT(explained(0.75), 0.5);
}

TEST(CheckTest, AFaceInTheMiddleOfALargePlaneHasNoOutline) {
  // The commonest false alarm: a flat part "found" on the flat floor of the bin.
  DepthImage image{test::pinholeCamera(320, 240, 600.0), Image<float>(320, 240, 500.0f)};
  const Mesh plate = test::plateMesh(60.0, 40.0);
  const Pose pose{glm::dmat3(1.0), {0.0, 0.0, 500.0}};
  const SurfaceWindow window = test::wholeWindow(image.camera);
  const CheckResult result = checkOf(plate, image, pose, window);
  EXPECT_GT(result.explained, 0.99);
  EXPECT_LT(result.outline, 0.05);
  EXPECT_LT(result.score, 0.35);
}

TEST(CheckTest, AnEdgeAtWhichAPartTouchesTheTableIsAnEndOfItsOutline) {
  const Mesh box = test::meshOf({{{-20, -20, 0}, {20, 20, 30}}});
  DepthImage image{test::pinholeCamera(320, 240, 600.0), {}};
  Pose pose;
  pose.rotation = rotationFromVector({std::numbers::pi + 0.7, 0.0, 0.0});
  pose.translation_mm = {0.0, 0.0, 400.0};
  test::measure(image, box, pose);
  test::measure(image, test::plateMesh(600.0, 600.0), pose);
  const SurfaceWindow window = test::wholeWindow(image.camera);
  const CheckResult result = checkOf(box, image, pose, window);
  EXPECT_GT(result.outline, 0.95) << "parts in plain view on a table would be unsure";
  EXPECT_LT(result.outline_covered, 0.05);
}

/// A step of 20 mm between two plates, seen from above, and data that shows a part of it.
struct Step {
  Mesh mesh = test::meshOf({{{-30, -30, 0}, {0, 30, 2}}, {{0, -30, 20}, {30, 30, 22}}});
  Pose pose{rotationFromVector({std::numbers::pi, 0.0, 0.0}), {0.0, 0.0, 500.0}};
  DepthImage image{test::pinholeCamera(320, 240, 600.0), {}};
  Step() { test::measure(image, mesh, pose); }
  CheckResult check() const { return checkOf(mesh, image, pose, test::wholeWindow(image.camera)); }
};

TEST(CheckTest, AStepThatIsInTheDataHasReliefAndAFlatFaceHasNone) {
  Step step;
  EXPECT_GT(step.check().relief, 2.0) << "the surest sign of a part would not count";
  // The data goes on level at the height of the nearer plate, as another part's would.
  for (float& depth : step.image.depth_mm) depth = depth > 0.0f ? 478.0f : 0.0f;
  EXPECT_LT(step.check().relief, 0.1) << "a part would be found on any plate";
  const Mesh plate = test::plateMesh(60.0, 40.0);
  const DepthImage level{test::pinholeCamera(320, 240, 600.0), Image<float>(320, 240, 500.0f)};
  const CheckResult flat =
      checkOf(plate, level, {glm::dmat3(1.0), {0.0, 0.0, 500.0}}, test::wholeWindow(level.camera));
  EXPECT_LT(flat.relief, 0.1) << "a face that lies on a wall would be sure";
}

TEST(CheckTest, WhatTheSensorSawThroughCountsInsideOnly) {
  Step step;
  EXPECT_EQ(step.check().seen_through, 0.0);
  // Rims smeared by a pixel or two are no holes.
  Step smeared;
  const Image<float> sharp = smeared.image.depth_mm;
  for (int v = 1; v < 239; ++v) {
    for (int u = 1; u < 319; ++u) {
      const float beside = sharp.at(u - 1, v);
      if (sharp.at(u, v) > 0.0f && beside > sharp.at(u, v))
        smeared.image.depth_mm.at(u, v) = beside;
    }
  }
  EXPECT_LT(smeared.check().seen_through, 0.002) << "sensors that smear jumps would lose parts";
  for (float& depth : step.image.depth_mm) depth = depth > 0.0f && depth < 485.0f ? 495.0f : depth;
  EXPECT_GT(step.check().seen_through, 0.3) << "half of the part is not there";
}

TEST(CheckTest, InnerPixelsAreThoseBesideNoOutline) {
  const Mesh plate = test::plateMesh(60.0, 40.0);
  const DepthImage level{test::pinholeCamera(320, 240, 600.0), Image<float>(320, 240, 600.0f)};
  const CheckResult whole =
      checkOf(plate, level, {glm::dmat3(1.0), {0.0, 0.0, 600.0}}, test::wholeWindow(level.camera));
  // 60 x 40 px, their border of one pixel left out.
  EXPECT_NEAR(whole.inner_px, 58.0 * 38.0, 2.0 * (58.0 + 38.0));
  const Mesh strip = test::plateMesh(60.0, 2.0);
  const CheckResult narrow =
      checkOf(strip, level, {glm::dmat3(1.0), {0.0, 0.0, 600.0}}, test::wholeWindow(level.camera));
  EXPECT_LT(narrow.inner_px, 62.0) << "what is two pixels wide would be as sure as a face";
}

TEST(CheckTest, NothingRenderedScoresNothing) {
  const Bench bench;
  const CheckResult empty = host::check({}, {}, bench.image, bench.around(bench.truth), {});
  EXPECT_EQ(empty.pixels, 0);
  EXPECT_EQ(empty.score, 0.0);
  EXPECT_EQ(host::checkPoints({}, bench.truth, 0.0, bench.image, {}).score, 0.0);
  const CheckResult outside = bench.checkPoints(bench.truth);
  EXPECT_GT(outside.pixels, 0);
}

TEST(CheckTest, PointsOutsideOfTheImageAreMissing) {
  const Bench bench;
  const std::vector<SurfacePoint> points = {{{0, 0, 0}, {0, 0, -1}}, {{1, 0, 0}, {0, 0, -1}}};
  const CheckResult result =
      host::checkPoints(points, {glm::dmat3(1.0), {1e7, 0.0, 500.0}}, 10.0, bench.image, {});
  EXPECT_EQ(result.missing, 1.0);
  EXPECT_EQ(result.score, 0.0);
}

}  // namespace
}  // namespace rangepose
