// Refinement on renders without noise: what it leaves is its own error, not the sensor's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stages/icp_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A part in front of a camera and what is needed to refine a pose of it.
struct Bench {
  Mesh mesh = test::meshOf(test::bracketBoxes());
  Sphere sphere = boundingSphere(mesh);
  Camera camera = test::pinholeCamera(320, 240, 600.0);
  Pose truth{test::looking({0.45, 0.75, -0.5}), {5.0, -8.0, 450.0}};

  Image<float> scene() const {
    DepthImage image{camera, {}};
    test::measure(image, mesh, truth);
    return image.depth_mm;
  }
  std::vector<SurfacePoint> pointsAt(const Pose& pose) const {
    const SurfaceWindow window =
        windowAround(camera, pose * sphere.center_mm, sphere.radius_mm, 1000);
    return pointsOfSurface(
        host::renderSurface(mesh, camera, pose, window), camera, window, pose, 1500);
  }
  /// The truth, turned about the part's middle and moved.
  Pose displaced(const glm::dvec3& turn, const glm::dvec3& shift_mm) const {
    Pose pose;
    pose.rotation = rotationFromVector(turn) * truth.rotation;
    pose.translation_mm = truth * sphere.center_mm + shift_mm - pose.rotation * sphere.center_mm;
    return pose;
  }
  /// Renders and aligns a few times, as refinement does.
  IcpResult refine(Pose pose, const Image<float>& scene_mm) const {
    IcpResult result;
    for (int round = 0; round < 4; ++round) {
      IcpOptions options;
      if (round > 0) options.first_reach_mm = 2.0;
      result = host::icp(
          pointsAt(pose), camera, scene_mm, pose, sphere.center_mm, sphere.radius_mm, options);
      pose = result.camera_from_object;
    }
    return result;
  }
  double vertexError(const Pose& pose) const {
    double largest = 0.0;
    for (const glm::vec3& vertex : mesh.vertices) {
      largest =
          std::max(largest, glm::distance(pose * glm::dvec3(vertex), truth * glm::dvec3(vertex)));
    }
    return largest;
  }
};

/// What is left without noise, on every vertex [mm].
constexpr double kRefinedMm = 0.05;

TEST(IcpTest, ADisplacedPartComesBack) {
  Bench bench;
  for (const bool parallel : {false, true}) {
    if (parallel) bench.camera = test::parallelCamera(320, 240, 0.7);
    const Image<float> scene = bench.scene();
    for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {-0.6, 0.6, -0.52}}) {
      const glm::dvec3 shift = 2.0 * glm::dvec3(axis.z, axis.x, -axis.y);
      const Pose start = bench.displaced(3.0 * kDegree * axis, shift);
      ASSERT_GT(bench.vertexError(start), 1.5);
      const IcpResult result = bench.refine(start, scene);
      EXPECT_LT(bench.vertexError(result.camera_from_object), kRefinedMm) << parallel;
      EXPECT_LT(result.rms_mm, kRefinedMm);
      EXPECT_GT(result.paired, 0.9);
    }
  }
}

TEST(IcpTest, TheTruthStays) {
  const Bench bench;
  const IcpResult result = bench.refine(bench.truth, bench.scene());
  EXPECT_LT(bench.vertexError(result.camera_from_object), kRefinedMm);
}

TEST(IcpTest, WhatIsHiddenHasNoSay) {
  Bench bench;
  Image<float> scene = bench.scene();
  // Something 60 mm nearer lies over a side of the part.
  const double middle = bench.camera.project(bench.truth * bench.sphere.center_mm).x;
  int hidden = 0;
  int seen = 0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (scene.at(u, v) == 0.0f) continue;
      ++seen;
      if (u > middle - 4.0) continue;
      scene.at(u, v) -= 60.0f;
      ++hidden;
    }
  }
  ASSERT_GT(hidden, seen / 5);
  ASSERT_LT(hidden, seen * 3 / 4);
  const IcpResult result =
      bench.refine(bench.displaced({0.01, -0.02, 0.01}, {1.0, 0.5, -1.0}), scene);
  EXPECT_LT(bench.vertexError(result.camera_from_object), 3.0 * kRefinedMm)
      << "pulled to the occluder";
  EXPECT_NEAR(result.paired, 1.0 - static_cast<double>(hidden) / seen, 0.08);
}

TEST(IcpTest, PointsBehindNarrowThingsDoNotBorrowTheirNeighboursData) {
  // Wires 3 px wide: the data on either side is within reach of the points behind them.
  const Bench bench;
  Image<float> scene = bench.scene();
  int hidden = 0;
  int seen = 0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (scene.at(u, v) == 0.0f) continue;
      ++seen;
      if (u % 10 >= 3) continue;
      scene.at(u, v) -= 60.0f;
      ++hidden;
    }
  }
  IcpOptions options;
  options.iterations = 1;
  options.last_reach_mm = options.first_reach_mm;
  const IcpResult result = host::icp(bench.pointsAt(bench.truth),
                                     bench.camera,
                                     scene,
                                     bench.truth,
                                     bench.sphere.center_mm,
                                     bench.sphere.radius_mm,
                                     options);
  EXPECT_NEAR(result.paired, 1.0 - static_cast<double>(hidden) / seen, 0.05);
  EXPECT_LT(bench.vertexError(result.camera_from_object), kRefinedMm);
}

/// A plate of 80 x 60 mm that lies 2 mm above a table, with a corner under something.
struct PlateBench {
  Mesh mesh = test::plateMesh(80.0, 60.0);
  Camera camera = test::pinholeCamera(320, 240, 600.0);
  Pose truth{rotationFromVector({0.1, -0.15, 0.4}), {12.0, -8.0, 500.0}};
  Image<float> scene;

  PlateBench() {
    DepthImage image{camera, {}};
    Pose table = truth;
    table.translation_mm += 2.0 * truth.rotation[2];
    test::measure(image, test::plateMesh(900.0, 900.0), table);
    test::measure(image, mesh, truth);
    Pose above = truth;
    above.translation_mm += truth.rotation * glm::dvec3(40.0, 30.0, -30.0);
    test::measure(image, test::plateMesh(30.0, 30.0), above);
    scene = image.depth_mm;
  }
  Pose shifted(const glm::dvec3& in_plane_mm) const {
    Pose pose = truth;
    pose.translation_mm += truth.rotation * in_plane_mm;
    return pose;
  }
  /// Renders the plate and aligns what is seen of it, with its rim.
  Pose aligned(const Pose& pose, const IcpOptions& options) const {
    const SurfaceWindow window = windowAround(camera, pose.translation_mm, 51.0, 1000);
    const Image<SurfaceTexel> surface = host::renderSurface(mesh, camera, pose, window);
    std::vector<SurfacePoint> points = pointsOfSurface(surface, camera, window, pose, 900);
    const std::vector<SurfacePoint> rim = rimOfSurface(surface, camera, window, pose, 900);
    points.insert(points.end(), rim.begin(), rim.end());
    return host::icp(points, camera, scene, pose, {0.0, 0.0, 0.0}, 51.0, options)
        .camera_from_object;
  }
  /// How far the plate lies from where it is after a few rounds [mm].
  double left(Pose pose, double rim_reach_mm) const {
    IcpOptions options;
    options.first_reach_mm = options.last_reach_mm = 1.0;
    options.rim_reach_mm = rim_reach_mm;
    options.slide = 0.001;
    for (int round = 0; round < 8; ++round) {
      pose = aligned(pose, options);
    }
    double farthest = 0.0;
    for (const glm::vec3& corner : mesh.vertices) {
      farthest =
          std::max(farthest, glm::distance(pose * glm::dvec3(corner), truth * glm::dvec3(corner)));
    }
    return farthest;
  }
};

TEST(IcpTest, RimsKeepAPlateFromSlidingInItsPlane) {
  const PlateBench bench;
  for (const glm::dvec3 shift : {glm::dvec3(3.0, 0.0, 0.0), {0.0, -3.0, 0.0}, {2.0, 2.0, 0.0}}) {
    const Pose start = bench.shifted(shift);
    EXPECT_LT(bench.left(start, 4.0), 0.4) << "half a pixel";
    EXPECT_GT(bench.left(start, 0.0), 1.0) << "needs no rims: this test shows nothing";
  }
  EXPECT_LT(bench.left(bench.truth, 4.0), 0.4);
}

TEST(IcpTest, RimsBeyondTheirReachHaveNoSay) {
  const PlateBench bench;
  EXPECT_GT(bench.left(bench.shifted({6.0, 0.0, 0.0}), 2.0), 4.0);
}

/// A rough pose is off in depth too, by more than what tells a plate from the table below it: yet
/// its first step is one towards the plate's border.
TEST(IcpTest, RimsFollowTheDataWhereAPoseIsOffInDepth) {
  const PlateBench bench;
  const auto after = [&](const glm::dvec3& shift_mm) {
    IcpOptions options;
    options.iterations = 1;
    options.first_reach_mm = 12.0;
    options.last_reach_mm = 1.0;
    options.rim_reach_mm = 6.0;
    options.slide = 0.001;
    const Pose moved = bench.aligned(bench.shifted(shift_mm), options);
    const glm::dvec3 left =
        glm::transpose(bench.truth.rotation) * (moved.translation_mm - bench.truth.translation_mm);
    return glm::length(glm::dvec2(left));
  };
  for (const double above_mm : {-4.0, 4.0}) {
    EXPECT_LT(after({3.0, 0.0, above_mm}), 2.1) << "mm left of 3";
    EXPECT_LT(after({0.0, -3.0, above_mm}), 2.1) << "mm left of 3";
  }
}

TEST(IcpTest, WithoutPartnersThePoseIsKept) {
  const Bench bench;
  const Pose start = bench.displaced({0.01, 0.02, 0.0}, {1.0, 0.0, 0.0});
  const std::vector<SurfacePoint> points = bench.pointsAt(start);
  const auto kept =
      [&](const Image<float>& scene, const std::vector<SurfacePoint>& use, const Pose& from) {
        const IcpResult result = host::icp(
            use, bench.camera, scene, from, bench.sphere.center_mm, bench.sphere.radius_mm, {});
        EXPECT_EQ(result.paired, 0.0);
        EXPECT_EQ(result.camera_from_object.translation_mm, from.translation_mm);
        EXPECT_EQ(result.camera_from_object.rotation, from.rotation);
      };
  kept(Image<float>(320, 240, 0.0f), points, start);
  kept(bench.scene(), {}, start);
  Pose behind = start;
  behind.translation_mm.z = -450.0;
  kept(bench.scene(), points, behind);
  Pose outside = start;
  outside.translation_mm.x = 1e9;
  kept(bench.scene(), points, outside);
}

TEST(IcpTest, TheSameTwiceIsBitIdentical) {
  const Bench bench;
  const Image<float> scene = bench.scene();
  const Pose start = bench.displaced({0.03, 0.02, 0.0}, {1.0, 0.0, 1.0});
  const Pose first = bench.refine(start, scene).camera_from_object;
  const Pose second = bench.refine(start, scene).camera_from_object;
  EXPECT_EQ(first.rotation, second.rotation);
  EXPECT_EQ(first.translation_mm, second.translation_mm);
}

}  // namespace
}  // namespace rangepose
