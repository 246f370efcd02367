// Depth image to orthographic range image: an error here bends every scene before the search sees
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "stages/channels_host.h"
#include "stages/resample_host.h"
#include "support/range_scenes.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

/// Projection and unprojection in float at depths of 700 mm.
constexpr double kFloatPx = 2e-3;

/// A virtual camera that looks along `axis` (turned by it) at a point of the scene, `distance_mm`
/// away.
OrthoCamera lookingAt(const glm::dvec3& target,
                      const glm::dvec3& turn,
                      double distance_mm,
                      int width,
                      int height,
                      double pixel_mm) {
  OrthoCamera camera;
  camera.width = width;
  camera.height = height;
  camera.pixel_mm = pixel_mm;
  camera.camera_from_ortho.rotation = rotationFromVector(turn);
  camera.camera_from_ortho.translation_mm =
      target - camera.camera_from_ortho.rotation * glm::dvec3(0.0, 0.0, distance_mm);
  return camera;
}

/// The camera of a search window: it looks along the viewing ray through a point and is not rolled.
OrthoCamera alongRay(
    const Camera& sensor, const glm::dvec3& target, int width, int height, double pixel_mm) {
  OrthoCamera camera = lookingAt(target, glm::dvec3(0.0), 0.0, width, height, pixel_mm);
  const glm::dvec3 z = sensor.viewingRay(target);
  const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0, 0) - z.x * z);
  camera.camera_from_ortho = {glm::dmat3(x, glm::cross(z, x), z), target - 300.0 * z};
  return camera;
}

/// An infinite plane n x = offset as the sensor sees it.
DepthImage planeImage(const Camera& sensor, const glm::dvec3& normal, double offset) {
  DepthImage image{sensor, Image<float>(sensor.width, sensor.height)};
  for (int v = 0; v < sensor.height; ++v) {
    for (int u = 0; u < sensor.width; ++u) {
      const double depth = sensor.orthographic
                               ? (offset - glm::dot(normal, sensor.unproject(u, v, 0.0))) / normal.z
                               : offset / glm::dot(normal, sensor.unproject(u, v, 1.0));
      image.depth_mm.at(u, v) = static_cast<float>(depth);
    }
  }
  return image;
}

/// Range of that plane along the ray of pixel (x, y) of the virtual camera [px].
double planeRange(
    const OrthoCamera& camera, const glm::dvec3& normal, double offset, int x, int y) {
  const glm::dvec3 start = camera.camera_from_ortho * camera.orthoFromPixel(x, y, 0.0);
  const glm::dvec3 along = camera.camera_from_ortho.rotation * glm::dvec3(0, 0, 1);
  return (offset - glm::dot(normal, start)) / glm::dot(normal, along) / camera.pixel_mm;
}

/// Whether the sensor measured all around the point that a virtual pixel sees.
bool insideOutline(const OrthoCamera& camera, const Camera& sensor, int x, int y, double range_px) {
  const glm::dvec2 pixel =
      sensor.project(camera.camera_from_ortho * camera.orthoFromPixel(x, y, range_px));
  constexpr double kRim = 6.0;
  return pixel.x > kRim && pixel.y > kRim && pixel.x < sensor.width - kRim &&
         pixel.y < sensor.height - kRim;
}

struct PlaneView {
  Camera sensor;
  glm::dvec3 normal;
  glm::dvec3 target;  ///< on the plane and at the middle of the view
};

struct PlaneResult {
  int compared = 0;
  int pin_holes = 0;
  int pin_holes_after_median = 0;
};

/// Compares the whole view with the plane.
PlaneResult comparePlane(const PlaneView& view, double pixel_mm) {
  const double offset = glm::dot(view.normal, view.target);
  const int width = std::min(96, static_cast<int>(300.0 / pixel_mm));
  const OrthoCamera camera = alongRay(view.sensor, view.target, width, width * 2 / 3, pixel_mm);
  const Image<float> range =
      host::resample(planeImage(view.sensor, view.normal, offset), {}, camera);
  const Image<float> filtered = host::median(range);
  const auto exact = [&](int x, int y) { return planeRange(camera, view.normal, offset, x, y); };
  // A splat carries the range of its own centre to pixels up to half a footprint away, and of all
  // that reach a pixel the nearest wins.
  const double footprint_px = std::ceil(view.sensor.pixelSpacingMm(900.0) / pixel_mm);
  const double slope = std::abs(exact(1, 0) - exact(0, 0)) + std::abs(exact(0, 1) - exact(0, 0));
  const double bound = kFloatPx + 0.5 * (footprint_px + 1.0) * slope;
  PlaneResult result;
  double largest = 0.0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double expected = exact(x, y);
      if (!insideOutline(camera, view.sensor, x, y, expected)) continue;
      ++result.compared;
      result.pin_holes += range.at(x, y) == 0.0f ? 1 : 0;
      result.pin_holes_after_median += filtered.at(x, y) == 0.0f ? 1 : 0;
      if (range.at(x, y) != 0.0f) largest = std::max(largest, std::abs(range.at(x, y) - expected));
    }
  }
  EXPECT_LT(largest, bound) << "surfaces are bent";
  return result;
}

TEST(ResampleTest, APlaneKeepsItsRangeAndHasNoPinHoles) {
  for (const Camera& sensor :
       {test::pinholeCamera(161, 121, 203.7), test::parallelCamera(161, 121, 3.3)}) {
    for (const glm::dvec3 tilt : {glm::dvec3(0, 0, -1), {0.3, -0.2, -1}, {-0.5, 0.5, -1}}) {
      for (const glm::dvec3 target : {glm::dvec3(0, 0, 700), {150, -100, 700}, {-120, 110, 650}}) {
        // Coarser than the sensor's 3.4 mm to finer than the largest footprint.
        for (const double pixel_mm : {5.1, 3.1, 1.9, 1.3, 0.57}) {
          const PlaneResult result = comparePlane({sensor, glm::normalize(tilt), target}, pixel_mm);
          const std::string where = "tilt " + std::to_string(tilt.x) + ", target " +
                                    std::to_string(target.x) + ", " + std::to_string(pixel_mm) +
                                    " mm";
          EXPECT_GT(result.compared, 1000) << where;
          // A footprint is that of a surface that faces the sensor. One that leans away from it,
          // beside the middle of the view, may open gaps one pixel wide, which the median closes.
          const double allowed = tilt.x == 0.0 ? 0.0 : 0.06 * result.compared;
          EXPECT_LE(result.pin_holes, allowed) << where;
          EXPECT_EQ(result.pin_holes_after_median, 0) << where << ": edges where there are none";
        }
      }
    }
  }
}

TEST(ResampleTest, APlaneAcrossTheViewIsExactEvenWhenRolled) {
  const glm::dvec3 normal(0.0, 0.0, -1.0);
  const DepthImage image = planeImage(test::pinholeCamera(161, 121, 203.7), normal, -700.0);
  for (const double roll : {0.0, 0.7}) {
    const OrthoCamera camera = lookingAt({0.0, 0.0, 700.0}, {0.0, 0.0, roll}, 250.0, 64, 64, 1.6);
    int pin_holes = 0;
    for (const float range : host::resample(image, {}, camera)) {
      if (range == 0.0f) {
        ++pin_holes;
        continue;
      }
      ASSERT_NEAR(range, 250.0 / 1.6, kFloatPx);
    }
    // A rolled grid of squares leaves gaps of single pixels, which the median closes.
    EXPECT_LE(pin_holes, roll == 0.0 ? 0 : 64 * 64 / 100);
  }
}

TEST(ResampleTest, APointLandsOnItsPixelAndCoversItsOwnWidth) {
  DepthImage image{test::pinholeCamera(101, 101, 100.0), Image<float>(101, 101)};
  image.depth_mm.at(60, 30) = 500.0f;  // 5 mm wide, at x = 50, y = -100
  for (const auto& [pixel_mm, side] :
       {std::pair{5.5, 1}, {2.6, 2}, {1.7, 3}, {0.1, kMaxFootprint}}) {
    const OrthoCamera camera =
        lookingAt({50.0, -100.0, 500.0}, glm::dvec3(0.0), 400.0, 33, 33, pixel_mm);
    const Image<float> range = host::resample(image, {}, camera);
    double x_sum = 0.0;
    double y_sum = 0.0;
    int covered = 0;
    for (int y = 0; y < 33; ++y) {
      for (int x = 0; x < 33; ++x) {
        if (range.at(x, y) == 0.0f) continue;
        EXPECT_NEAR(range.at(x, y), 400.0 / pixel_mm, kFloatPx * 5.0);
        ++covered;
        x_sum += x;
        y_sum += y;
      }
    }
    ASSERT_EQ(covered, side * side) << pixel_mm;
    EXPECT_NEAR(x_sum / covered, 16.0, 0.5) << pixel_mm;
    EXPECT_NEAR(y_sum / covered, 16.0, 0.5) << pixel_mm;
  }
}

TEST(ResampleTest, TheNearestMeasurementWins) {
  DepthImage image{test::parallelCamera(64, 48, 1.0), Image<float>(64, 48, 900.0f)};
  for (int v = 10; v < 30; ++v) {
    for (int u = 20; u < 40; ++u)
      image.depth_mm.at(u, v) = 600.0f + static_cast<float>((u + v) % 7);
  }
  const OrthoCamera coarse = lookingAt({0, 0, 900}, glm::dvec3(0.0), 900.0, 8, 6, 8.0);
  const Image<float> range = host::resample(image, {}, coarse);
  // 64 measurements in each pixel; the block covers pixels that lie wholly inside of it.
  EXPECT_NEAR(range.at(3, 2), 600.0 / 8.0, kFloatPx);
  EXPECT_NEAR(range.at(7, 5), 900.0 / 8.0, kFloatPx);
}

TEST(ResampleTest, WhatIsBehindTheVirtualCameraIsDropped) {
  DepthImage image{test::pinholeCamera(64, 48, 80.0), Image<float>(64, 48, 600.0f)};
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 32; ++u) image.depth_mm.at(u, v) = 300.0f;
  }
  OrthoCamera camera = lookingAt({0, 0, 600}, glm::dvec3(0.0), 200.0, 64, 64, 8.0);
  int kept = 0;
  for (const float range : host::resample(image, {}, camera)) {
    EXPECT_TRUE(range == 0.0f || std::abs(range - 25.0f) < 0.01f)
        << "a range must never be negative";
    kept += range != 0.0f ? 1 : 0;
  }
  EXPECT_GT(kept, 500);
}

TEST(ResampleTest, MaskAndRegionLeavePixelsOut) {
  const Camera sensor = test::parallelCamera(40, 30, 1.0);
  const DepthImage image{sensor, Image<float>(40, 30, 500.0f)};
  const OrthoCamera camera = lookingAt({0, 0, 500}, glm::dvec3(0.0), 100.0, 40, 30, 1.0);
  Image<std::uint8_t> keep(40, 30, 1);
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 10; ++u) keep.at(u, v) = 0;
  }
  const PixelBox region{5, 8, 25, 20};
  const Image<float> range = host::resample(image, keep, camera, region);
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      const bool read = u >= 10 && u < 25 && v >= 8 && v < 20;
      EXPECT_EQ(range.at(u, v) != 0.0f, read) << u << ", " << v;
    }
  }
  EXPECT_EQ(host::resample(image, {}, camera),
            host::resample(image, Image<std::uint8_t>(40, 30, 255), camera));
}

TEST(ResampleTest, NothingIsEverNotANumberOrNegative) {
  DepthImage image{test::pinholeCamera(97, 71, 120.0), test::randomBlobs(97, 71, 4)};
  test::Random random(9);
  for (float& depth : image.depth_mm) depth *= 6.0f;
  for (int i = 0; i < 30; ++i) image.depth_mm.at(random.index(97), random.index(71)) = 1e-3f;
  for (int i = 0; i < 30; ++i) image.depth_mm.at(random.index(97), random.index(71)) = 6e4f;
  for (int i = 0; i < 20; ++i) {
    const glm::dvec3 turn(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
    const OrthoCamera camera =
        lookingAt({0, 0, 600}, turn, random.uniform(-100, 700), 61, 64, random.uniform(0.1, 20.0));
    for (const float range : host::resample(image, {}, camera)) {
      ASSERT_TRUE(std::isfinite(range) && range >= 0.0f);
    }
  }
  const DepthImage nothing{image.camera, Image<float>(97, 71, 0.0f)};
  EXPECT_EQ(
      host::resample(nothing, {}, lookingAt({0, 0, 600}, glm::dvec3(0.1), 300.0, 20, 20, 1.0)),
      Image<float>(20, 20, 0.0f));
}

}  // namespace
}  // namespace rangepose
