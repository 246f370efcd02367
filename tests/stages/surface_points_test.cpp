// Points of the partial mesh: refinement aligns exactly these, so each must lie on the part.
#include "stages/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

namespace oracle = test::oracle;

TEST(SurfacePointsTest, RenderedPointsLieOnTheirFaces) {
  const Mesh mesh = test::meshOf(test::bracketBoxes());
  const Sphere sphere = boundingSphere(mesh);
  for (const Camera& camera :
       {test::pinholeCamera(320, 240, 600.0), test::parallelCamera(320, 240, 0.5)}) {
    for (const glm::dvec3 turn : {glm::dvec3(0.7, 0.5, 0.1), {-2.0, 0.4, 0.9}}) {
      const Pose pose{rotationFromVector(turn), {15.0, -20.0, 500.0}};
      for (const int max_pixels : {1000, 40}) {
        const SurfaceWindow window =
            windowAround(camera, pose * sphere.center_mm, sphere.radius_mm, max_pixels);
        const Image<SurfaceTexel> surface = host::renderSurface(mesh, camera, pose, window);
        const std::vector<SurfacePoint> points =
            pointsOfSurface(surface, camera, window, pose, 300);
        ASSERT_GT(points.size(), 50U);
        EXPECT_LT(points.size(), 330U);
        for (const SurfacePoint& point : points) {
          const oracle::NearestFace face = oracle::nearestFace(mesh, glm::dvec3(point.position_mm));
          ASSERT_LT(face.distance_mm, 1e-3);
          ASSERT_NEAR(glm::length(point.normal), 1.0, 1e-5);
          const glm::dvec3 in_camera = pose * glm::dvec3(point.position_mm);
          const glm::dvec3 normal = pose.rotation * glm::dvec3(point.normal);
          ASSERT_LT(glm::dot(normal, camera.viewingRay(in_camera)), 1e-6)
              << "turned away from the viewer";
        }
      }
    }
  }
}

TEST(SurfacePointsTest, RenderedNormalsAreThoseOfTheFace) {
  const Mesh plate = test::plateMesh(80.0, 60.0);
  const Camera camera = test::pinholeCamera(320, 240, 600.0);
  const Pose pose{rotationFromVector({0.5, -0.3, 1.0}), {0.0, 0.0, 500.0}};
  const SurfaceWindow window = windowAround(camera, pose.translation_mm, 50.0, 1000);
  const Image<SurfaceTexel> surface = host::renderSurface(plate, camera, pose, window);
  const std::vector<SurfacePoint> points = pointsOfSurface(surface, camera, window, pose, 500);
  ASSERT_GT(points.size(), 200U);
  for (const SurfacePoint& point : points) {
    // Of the two sides of a thin plate the visible one.
    const double side = pose.rotation[2].z > 0.0 ? -1.0 : 1.0;
    ASSERT_LT(glm::distance(glm::dvec3(point.normal), glm::dvec3(0, 0, side)), 1e-5);
    ASSERT_NEAR(point.position_mm.z, 0.0, 1e-3);
  }
}

/// A plate's rim is its border, wherever the camera looks from.
TEST(SurfacePointsTest, RimLiesOnTheBorderAndLooksOutOfIt) {
  constexpr double kHalfWidth = 40.0;
  constexpr double kHalfHeight = 30.0;
  const Mesh plate = test::plateMesh(2.0 * kHalfWidth, 2.0 * kHalfHeight);
  for (const Camera& camera :
       {test::pinholeCamera(320, 240, 600.0), test::parallelCamera(320, 240, 0.8)}) {
    for (const glm::dvec3 turn : {glm::dvec3(0.0), {0.0, 0.0, 0.7}, {0.5, -0.3, 1.0}}) {
      const Pose pose{rotationFromVector(turn), {25.0, -10.0, 500.0}};
      const SurfaceWindow window = windowAround(camera, pose.translation_mm, 51.0, 1000);
      const Image<SurfaceTexel> surface = host::renderSurface(plate, camera, pose, window);
      const std::vector<SurfacePoint> rim = rimOfSurface(surface, camera, window, pose, 500);
      const double pixel_mm = camera.pixelSpacingMm(500.0);
      ASSERT_GT(rim.size(), 30U);
      ASSERT_LT(rim.size(), 200U);
      double off_mm = 0.0;
      for (const SurfacePoint& point : rim) {
        ASSERT_TRUE(point.rim);
        const double right = std::abs(static_cast<double>(point.position_mm.x)) - kHalfWidth;
        const double below = std::abs(static_cast<double>(point.position_mm.y)) - kHalfHeight;
        ASSERT_LT(std::abs(std::max(right, below)), 1.5 * pixel_mm);
        off_mm += std::max(right, below);
        ASSERT_NEAR(glm::length(point.normal), 1.0, 1e-5);
        ASSERT_NEAR(point.normal.z, 0.0, 1e-4) << "leaves the plate's plane";
        const glm::vec2 side = right > below ? glm::vec2(point.position_mm.x, 0.0f)
                                             : glm::vec2(0.0f, point.position_mm.y);
        const bool corner = std::abs(right - below) < 4.0 * pixel_mm;
        if (!corner) {
          ASSERT_GT(glm::dot(glm::vec2(point.normal), side), 0.0f) << "leads back into the plate";
        }
      }
      EXPECT_LT(std::abs(off_mm / static_cast<double>(rim.size())), 0.2 * pixel_mm)
          << "a plate is seen larger or smaller than it is";
    }
  }
}

TEST(SurfacePointsTest, TheEndOfTheWindowIsNoRim) {
  const Camera camera = test::pinholeCamera(64, 48, 60.0);
  const Image<SurfaceTexel> wall(64, 48, SurfaceTexel(0.0f, 0.0f, -1.0f, 300.0f));
  EXPECT_TRUE(rimOfSurface(wall, camera, test::wholeWindow(camera), {}, 100).empty());
}

TEST(SurfacePointsTest, PointsOfAViewLieOnThePart) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 20, 64, 31);
  host::renderReferences(object, {}, {});
  int points_seen = 0;
  int agreeing = 0;
  for (int view = 0; view < 20; ++view) {
    const glm::dmat3& rotation = object.views[static_cast<std::size_t>(view)].rotation;
    const std::vector<SurfacePoint> points = pointsOfView(object, view, 200);
    EXPECT_LT(points.size(), 260U);
    for (const SurfacePoint& point : points) {
      const oracle::NearestFace face =
          oracle::nearestFace(object.mesh, glm::dvec3(point.position_mm));
      ASSERT_LT(face.distance_mm, 1e-3) << "view " << view;
      ASSERT_LT((rotation * glm::dvec3(point.normal)).z, 0.0) << "turned away from the viewer";
      ++points_seen;
      agreeing += std::abs(glm::dot(face.normal, glm::dvec3(point.normal))) > 0.999 ? 1 : 0;
    }
  }
  EXPECT_GT(points_seen, 1200);
  // Differences of neighbours mix two faces along their crease; elsewhere they are exact.
  EXPECT_GT(agreeing, 0.8 * points_seen);
}

/// The outline of each view, holes included: a step along a rim's tangent leads out of what the
/// view shows, a step back stays on it.
TEST(SurfacePointsTest, RimOfAViewIsWhereItEnds) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 20, 64, 31);
  host::renderReferences(object, {}, {});
  int seen = 0;
  int inside = 0;
  int outside = 0;
  for (int view = 0; view < 20; ++view) {
    const glm::dmat3& rotation = object.views[static_cast<std::size_t>(view)].rotation;
    const glm::ivec2 origin = object.tileOrigin(view);
    const auto shown = [&](const glm::dvec3& point_mm) {
      const glm::dvec3 in_view = rotation * (point_mm - object.center_mm) / object.pixel_mm;
      const glm::ivec2 at(glm::floor(glm::dvec2(in_view) + 0.5 * object.size));
      return object.atlas.at(origin.x + at.x, origin.y + at.y).a > 0.0f;
    };
    const std::vector<SurfacePoint> rim = rimOfView(object, view, 200);
    EXPECT_GT(rim.size(), 10U) << "view " << view;
    EXPECT_LT(rim.size(), 120U) << "view " << view;
    for (const SurfacePoint& point : rim) {
      ASSERT_TRUE(point.rim);
      const glm::dvec3 out(point.normal);
      ASSERT_NEAR(glm::length(out), 1.0, 1e-5);
      const glm::dvec2 in_image(rotation * out);
      ASSERT_GT(glm::length(in_image), 0.4) << "steeper than a rim's slope may be";
      const glm::dvec3 step = 1.2 * object.pixel_mm / glm::length(in_image) * out;
      ++seen;
      inside += shown(glm::dvec3(point.position_mm) - step) ? 1 : 0;
      outside += shown(glm::dvec3(point.position_mm) + step) ? 0 : 1;
    }
  }
  // At corners a straight step may stay on the part, or leave it on the other side.
  EXPECT_GT(inside, 0.93 * seen);
  EXPECT_GT(outside, 0.93 * seen);
}

TEST(SurfacePointsTest, RimOfAViewLiesOnThePlatesBorder) {
  ReferenceObject object =
      test::objectOf(std::vector<test::Box>{{{-30.0, -20.0, -1.0}, {30.0, 20.0, 1.0}}}, 30, 64, 31);
  host::renderReferences(object, {}, {});
  double off_mm = 0.0;
  int seen = 0;
  for (int view = 0; view < 30; ++view) {
    const glm::dmat3& rotation = object.views[static_cast<std::size_t>(view)].rotation;
    if (std::abs(rotation[2].z) < 0.6) continue;  // its narrow sides are then a part of the picture
    for (const SurfacePoint& point : rimOfView(object, view, 300)) {
      const double right = std::abs(static_cast<double>(point.position_mm.x)) - 30.0;
      const double below = std::abs(static_cast<double>(point.position_mm.y)) - 20.0;
      ASSERT_LT(std::abs(std::max(right, below)), 2.0 * object.pixel_mm);
      off_mm += std::max(right, below);
      ++seen;
    }
  }
  ASSERT_GT(seen, 200);
  EXPECT_LT(std::abs(off_mm / seen), 0.3 * object.pixel_mm)
      << "parts are taken for larger or smaller than they are";
}

TEST(SurfacePointsTest, AnEmptyViewOrSurfaceHasNoPoints) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 1, 64, 31);
  object.atlas = Image<ReferenceTexel>(64, 64, ReferenceTexel(0.0f));
  EXPECT_TRUE(pointsOfView(object, 0, 100).empty());
  EXPECT_TRUE(rimOfView(object, 0, 100).empty());
  const Camera camera = test::pinholeCamera(32, 24, 60.0);
  EXPECT_TRUE(pointsOfSurface({}, camera, {}, {}, 100).empty());
  const Image<SurfaceTexel> nothing(32, 24, SurfaceTexel(0.0f));
  EXPECT_TRUE(pointsOfSurface(nothing, camera, test::wholeWindow(camera), {}, 100).empty());
  EXPECT_TRUE(rimOfSurface({}, camera, {}, {}, 100).empty());
  EXPECT_TRUE(rimOfSurface(nothing, camera, test::wholeWindow(camera), {}, 100).empty());
}

}  // namespace
}  // namespace rangepose
