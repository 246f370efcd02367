// The software rasteriser against formulas: refinement and check trust every depth it gives.
#include "stages/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/box_mesh.h"
#include "support/range_scenes.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using test::Hit;

/// Depth of a flat face: one rounding to float at about 600 mm.
constexpr double kFlatMm = 1e-4;

std::vector<Camera> cameras() {
  return {test::pinholeCamera(160, 120, 300.0), test::parallelCamera(160, 120, 2.0)};
}

Pose poseAt(const glm::dvec3& turn, const glm::dvec3& position) {
  return {rotationFromVector(turn), position};
}

/// The ray of a camera pixel: start and unit direction in the camera frame.
std::pair<glm::dvec3, glm::dvec3> rayOf(const Camera& camera, double u, double v) {
  if (camera.orthographic) return {camera.unproject(u, v, 0.0), glm::dvec3(0, 0, 1)};
  return {glm::dvec3(0.0), glm::normalize(camera.unproject(u, v, 1.0))};
}

Hit hitAt(const Camera& camera,
          const Pose& pose,
          const std::vector<test::Box>& boxes,
          double u,
          double v) {
  const auto [start, direction] = rayOf(camera, u, v);
  const Pose object_from_camera = pose.inverse();
  return test::hitBoxes(boxes, object_from_camera * start, object_from_camera.rotation * direction);
}

bool onBorder(
    const Camera& camera, const Pose& pose, const std::vector<test::Box>& boxes, int u, int v) {
  const int face = hitAt(camera, pose, boxes, u, v).face;
  for (const double du : {-1e-3, 1e-3}) {
    for (const double dv : {-1e-3, 1e-3}) {
      if (hitAt(camera, pose, boxes, u + du, v + dv).face != face) return true;
    }
  }
  return false;
}

TEST(SurfaceTest, ABracketIsWhereTheRaysHitIt) {
  const std::vector<test::Box> boxes = test::bracketBoxes();
  const Mesh mesh = test::meshOf(boxes);
  test::Random random(5);
  int compared = 0;
  for (const Camera& camera : cameras()) {
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 turn(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
      const Pose pose = poseAt(turn, {random.uniform(-60, 60), random.uniform(-40, 40), 500.0});
      const SurfaceWindow window =
          i % 2 == 0 ? test::wholeWindow(camera) : SurfaceWindow{13, 7, 61, 33, 2};
      const Image<SurfaceTexel> surface = host::renderSurface(mesh, camera, pose, window);
      for (int y = 0; y < window.height; ++y) {
        for (int x = 0; x < window.width; ++x) {
          const int u = window.x0 + x * window.step;
          const int v = window.y0 + y * window.step;
          if (onBorder(camera, pose, boxes, u, v)) continue;
          const Hit hit = hitAt(camera, pose, boxes, u, v);
          const SurfaceTexel& texel = surface.at(x, y);
          ASSERT_EQ(texel.w > 0.0f, !std::isinf(hit.distance)) << u << ", " << v;
          if (texel.w == 0.0f) continue;
          const auto [start, direction] = rayOf(camera, u, v);
          // Vertices at 500 mm are rounded to float in the object's frame: a steep face feels it.
          ASSERT_NEAR(texel.w, start.z + hit.distance * direction.z, kFlatMm / hit.cosine);
          const glm::dvec3 axis = pose.rotation[hit.face % 3];
          ASSERT_NEAR(std::abs(glm::dot(axis, glm::dvec3(texel))), 1.0, 1e-6);
          ASSERT_LT(glm::dot(glm::dvec3(texel), direction), 0.0) << "normals must face the camera";
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST(SurfaceTest, ASphereIsRound) {
  constexpr double kRadius = 80.0;
  const Mesh mesh = test::sphereMesh(glm::dvec3(0.0), kRadius, 180);
  const glm::dvec3 center(25.0, -15.0, 600.0);
  for (const Camera& camera : cameras()) {
    const Image<SurfaceTexel> surface = host::renderSurface(
        mesh, camera, poseAt({0.4, 0.7, 0.1}, center), test::wholeWindow(camera));
    int seen = 0;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const auto [start, direction] = rayOf(camera, u, v);
        const double along = glm::dot(center - start, direction);
        const double miss = glm::length(center - start - along * direction);
        if (miss > kRadius) {
          ASSERT_EQ(surface.at(u, v).w, 0.0f) << u << ", " << v;
        }
        if (miss > 0.95 * kRadius) continue;
        const glm::dvec3 hit =
            start + (along - std::sqrt(kRadius * kRadius - miss * miss)) * direction;
        ASSERT_NEAR(surface.at(u, v).w, hit.z, 0.05) << u << ", " << v;
        ASSERT_GT(glm::dot(glm::dvec3(surface.at(u, v)), (hit - center) / kRadius), 0.999);
        ++seen;
      }
    }
    EXPECT_GT(seen, 3000);
  }
}

TEST(SurfaceTest, ASolidLooksTheSameWithoutItsBacks) {
  test::Random random(11);
  Mesh mesh = test::meshOf(test::bracketBoxes());
  int compared = 0;
  for (const Camera& camera : cameras()) {
    for (int i = 0; i < 20; ++i) {
      const glm::dvec3 turn(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
      // The last are so near that the part reaches behind the camera.
      const Pose pose = poseAt(turn, {random.uniform(-9, 9), 0.0, i < 15 ? 150.0 : 15.0});
      mesh.solid = false;
      const auto all = host::renderSurface(mesh, camera, pose, test::wholeWindow(camera));
      mesh.solid = true;
      const auto fronts = host::renderSurface(mesh, camera, pose, test::wholeWindow(camera));
      for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
          ASSERT_NEAR(all.at(u, v).w, fronts.at(u, v).w, kFlatMm) << u << ", " << v;
          if (all.at(u, v).w > 0.0f) ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(SurfaceTest, ATiltedPlateFollowsItsPlaneUpToItsOutline) {
  const Mesh plate = test::plateMesh(120.0, 80.0);
  const Pose pose = poseAt({0.5, -0.4, 0.2}, {10.0, 5.0, 550.0});
  for (const Camera& camera : cameras()) {
    const Image<SurfaceTexel> surface =
        host::renderSurface(plate, camera, pose, test::wholeWindow(camera));
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const auto [start, direction] = rayOf(camera, u, v);
        const glm::dvec3 normal = pose.rotation[2];
        const double along =
            glm::dot(pose.translation_mm - start, normal) / glm::dot(direction, normal);
        const glm::dvec3 on_plate = pose.inverse() * (start + along * direction);
        const double beyond = std::max(std::abs(on_plate.x) - 60.0, std::abs(on_plate.y) - 40.0);
        if (std::abs(beyond) < 1e-3) continue;
        ASSERT_EQ(surface.at(u, v).w > 0.0f, beyond < 0.0)
            << "gap between the triangles or wrong outline";
        if (beyond < 0.0) {
          ASSERT_NEAR(surface.at(u, v).w, (start + along * direction).z, kFlatMm);
        }
      }
    }
  }
}

TEST(SurfaceTest, TheNearerOfTwoPlatesIsSeenWhateverTheOrder) {
  Mesh mesh = test::plateMesh(100.0, 100.0);
  for (int corner = 0; corner < 4; ++corner)
    mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)] + glm::vec3(0, 0, 30));
  mesh.triangles.emplace_back(4, 5, 7);
  mesh.triangles.emplace_back(4, 7, 6);
  for (const Camera& camera : cameras()) {
    for (int order = 0; order < 2; ++order) {
      const Image<SurfaceTexel> surface = host::renderSurface(
          mesh, camera, poseAt({0, 0, 0}, {0, 0, 500}), test::wholeWindow(camera));
      EXPECT_FLOAT_EQ(surface.at(80, 60).w, 500.0f);
      std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    }
  }
}

TEST(SurfaceTest, WhatReachesBehindTheCameraIsLeftOut) {
  const Camera camera = test::pinholeCamera(160, 120, 300.0);
  const Mesh plate = test::plateMesh(100.0, 100.0);
  for (const double z : {-200.0, 0.0, 20.0}) {
    for (const SurfaceTexel& texel : host::renderSurface(
             plate, camera, poseAt({1.4, 0.0, 0.0}, {0.0, 0.0, z}), test::wholeWindow(camera))) {
      ASSERT_EQ(texel, SurfaceTexel(0.0f)) << "a part behind the camera is not seen, z " << z;
    }
  }
}

TEST(WindowAroundTest, HoldsTheWholeObjectWithinTheImage) {
  const Mesh mesh = test::meshOf(test::bracketBoxes());
  const Sphere sphere = boundingSphere(mesh);
  test::Random random(8);
  int seen = 0;
  for (const Camera& camera : cameras()) {
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 turn(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
      const Pose pose = poseAt(
          turn, {random.uniform(-250, 250), random.uniform(-250, 250), random.uniform(70, 700)});
      const int limit = i % 3 == 0 ? 17 : 1000;
      const SurfaceWindow window =
          windowAround(camera, pose * sphere.center_mm, sphere.radius_mm, limit);
      ASSERT_LE(std::max(window.width, window.height), limit);
      ASSERT_GE(window.step, 1);
      if (window.width > 0) {
        ASSERT_GE(window.x0, 0);
        ASSERT_GE(window.y0, 0);
        ASSERT_LT(window.x0 + (window.width - 1) * window.step, camera.width);
        ASSERT_LT(window.y0 + (window.height - 1) * window.step, camera.height);
      }
      for (const glm::vec3& vertex : mesh.vertices) {
        const glm::dvec2 pixel = camera.project(pose * glm::dvec3(vertex));
        if (pixel.x < 0 || pixel.y < 0 || pixel.x > camera.width - 1 || pixel.y > camera.height - 1)
          continue;
        ++seen;
        ASSERT_GE(pixel.x, window.x0);
        ASSERT_GE(pixel.y, window.y0);
        ASSERT_LE(pixel.x, window.x0 + window.width * window.step) << "the part is cut off";
        ASSERT_LE(pixel.y, window.y0 + window.height * window.step) << "the part is cut off";
      }
    }
  }
  EXPECT_GT(seen, 500);
}

TEST(WindowAroundTest, IsEmptyWhereNothingIsSeen) {
  const Camera camera = test::pinholeCamera(160, 120, 300.0);
  for (const glm::dvec3 center :
       {glm::dvec3(0, 0, -500), {0, 0, 10}, {900, 0, 500}, {0, -900, 500}}) {
    EXPECT_EQ(windowAround(camera, center, 30.0, 100).width, 0);
    const SurfaceWindow window = windowAround(camera, center, 30.0, 100);
    EXPECT_TRUE(
        host::renderSurface(test::plateMesh(50, 50), camera, poseAt({0, 0, 0}, center), window)
            .empty());
  }
}

}  // namespace
}  // namespace rangepose
