// Scenes for the statistics of scans: parts of known pose, and what an ideal sensor measures.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "eval/known_surface.h"
#include "sim/random.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose::test {

/// 320 x 240 pixels, 1.25 mm wide at a distance of 500 mm.
inline Camera scanCamera() { return pinholeCamera(320, 240, 400.0); }

/// A plate of 240 x 180 x 20 mm, leaning.
class LeaningPlate {
 public:
  LeaningPlate() {
    part_.mesh = &mesh_;
    part_.diameter_mm = diameter(mesh_);
    part_.camera_from_object = {rotationFromVector({0.3, 0.25, 0.0}), {0.0, 0.0, 500.0}};
  }
  const KnownPart& part() const { return part_; }
  DepthImage scan() const {
    DepthImage image;
    image.camera = scanCamera();
    measure(image, mesh_, part_.camera_from_object);
    return image;
  }

 private:
  Mesh mesh_ = meshOf({{{-120.0, -90.0, -10.0}, {120.0, 90.0, 10.0}}});
  KnownPart part_;
};

/// White noise of deviation 1.
inline Image<float> whiteNoise(int width, int height, std::uint64_t seed) {
  Random random(seed);
  Image<float> noise(width, height);
  for (float& value : noise) value = static_cast<float>(random.normal());
  return noise;
}

/// Noise of deviation 1 whose values have `1 - L / wide` in common with those L px off along a row
/// or a column: means over `wide` x `wide` pixels.
inline Image<float> commonNoise(int width, int height, int wide, std::uint64_t seed) {
  const Image<float> white = whiteNoise(width + wide, height + wide, seed);
  Image<float> noise(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      double sum = 0.0;
      for (int k = 0; k < wide * wide; ++k) sum += white.at(u + k % wide, v + k / wide);
      noise.at(u, v) = static_cast<float>(sum / wide);
    }
  }
  return noise;
}

inline void addNoise(DepthImage& image, const Image<float>& noise, double sigma_mm) {
  for (std::size_t i = 0; i < noise.size(); ++i) {
    float& depth = image.depth_mm.data()[i];
    if (depth > 0.0f) depth += static_cast<float>(sigma_mm) * noise.data()[i];
  }
}

/// A block seen from straight above, its top 500 mm away, on a floor that is not known, 560 mm
/// away. Its contour is a square about the image's middle, turned by kTurnRad.
class BlockOnFloor {
 public:
  static constexpr double kTopMm = 500.0;
  static constexpr double kFloorMm = 560.0;
  static constexpr double kHalfPx = 40.3;
  static constexpr double kTurnRad = 0.2;

  BlockOnFloor() {
    part_.mesh = &mesh_;
    part_.diameter_mm = diameter(mesh_);
    part_.camera_from_object = {rotationFromVector({0.0, 0.0, kTurnRad}), {0.0, 0.0, kTopMm}};
  }
  const KnownPart& part() const { return part_; }

  /// `depth` gives that of a pixel from (x, y) from the image's middle [px].
  static DepthImage scan(const std::function<double(const glm::dvec2& px)>& depth) {
    DepthImage image;
    image.camera = scanCamera();
    image.depth_mm = Image<float>(image.camera.width, image.camera.height);
    for (int v = 0; v < image.camera.height; ++v) {
      for (int u = 0; u < image.camera.width; ++u) {
        image.depth_mm.at(u, v) =
            static_cast<float>(depth(glm::dvec2(u - image.camera.cx, v - image.camera.cy)));
      }
    }
    return image;
  }
  /// Along the sides of the square [px].
  static glm::dvec2 along(const glm::dvec2& px) {
    const double c = std::cos(kTurnRad);
    const double s = std::sin(kTurnRad);
    return {c * px.x + s * px.y, c * px.y - s * px.x};
  }
  /// Distance from the contour, positive outside [px].
  static double outside(const glm::dvec2& px) {
    return std::max(std::abs(along(px).x), std::abs(along(px).y)) - kHalfPx;
  }
  static double ideal(const glm::dvec2& px) { return outside(px) < 0.0 ? kTopMm : kFloorMm; }

 private:
  static constexpr double kHalfMm = kHalfPx * kTopMm / 400.0;
  Mesh mesh_ = meshOf({{{-kHalfMm, -kHalfMm, 0.0}, {kHalfMm, kHalfMm, 40.0}}});
  KnownPart part_;
};

}  // namespace rangepose::test
