// Background planes, step by step. Shared by host and CUDA.
#pragma once

#include <cmath>

#include "stages/foreground.h"

namespace rangepose {

/// Planes are laid through so many triples of samples, the first that has most samples is taken.
inline constexpr int kPlaneTrials = 4000;
/// A plane is tried on at least so many of the samples, evenly taken from all, if there are as
/// many.
inline constexpr int kTrialSamples = 1500;
RP_HD int trialStride(int samples) { return samples > kTrialSamples ? samples / kTrialSamples : 1; }
/// A plane that was found is fitted to its samples so many times.
inline constexpr int kPlaneFits = 3;
/// Of fewer samples no plane is looked for.
inline constexpr int kFewestSamples = 50;

/// A measured point with the slope of the surface there.
struct SurfaceSample {
  glm::dvec3 point;
  glm::dvec3 normal;  ///< towards the camera; 0 where a neighbour is missing
};

/// How near to a plane a point must lie to belong to it [mm]: what thin parts ask for, as far as
/// the noise allows, and never more than for thick ones.
RP_HD double toleranceAt(double noise_mm, double coarse_mm, double thin_mm) {
  const double noisy_mm = 3.0 * noise_mm;
  const double least_mm = noisy_mm < coarse_mm ? noisy_mm : coarse_mm;
  const double fine_mm = thin_mm > least_mm ? thin_mm : least_mm;
  return fine_mm < coarse_mm ? fine_mm : coarse_mm;
}

/// Every n-th pixel of every n-th row is a sample: about so many of the measured ones.
inline constexpr double kSamplesWanted = 12000.0;

RP_HD int sampleStride(double measured) {
  const int stride = static_cast<int>(std::sqrt(measured / kSamplesWanted));
  return stride > 1 ? stride : 1;
}

/// Slope from the points `reach` pixels to either side, of 0.05 part diameters. `read(u, v)` gives
/// a depth [mm], also 0 outside of the image.
template <typename Read>
RP_HD SurfaceSample sampleAt(const Camera& camera, const Read& read, int u, int v, double part_mm) {
  constexpr int kLeast = 2;
  constexpr int kMost = 20;
  const double depth = read(u, v);
  SurfaceSample sample{camera.unproject(u, v, depth), glm::dvec3(0.0)};
  const int near = static_cast<int>(0.05 * part_mm / camera.pixelSpacingMm(depth));
  const int reach = near < kLeast ? kLeast : near > kMost ? kMost : near;
  const double left = read(u - reach, v);
  const double right = read(u + reach, v);
  const double up = read(u, v - reach);
  const double down = read(u, v + reach);
  if (left == 0.0 || right == 0.0 || up == 0.0 || down == 0.0) return sample;
  const glm::dvec3 x = camera.unproject(u + reach, v, right) - camera.unproject(u - reach, v, left);
  const glm::dvec3 y = camera.unproject(u, v + reach, down) - camera.unproject(u, v - reach, up);
  sample.normal = glm::normalize(glm::cross(y, x));
  return sample;
}

RP_HD BackgroundPlane facingCamera(glm::dvec3 normal, const glm::dvec3& point, bool orthographic) {
  const double towards = orthographic ? -normal.z : -glm::dot(normal, point);
  if (towards < 0.0) normal = -normal;
  return {normal, glm::dot(normal, point)};
}

/// Near it and sloped like it: a plane that cuts through a heap has as many points near it as a
/// floor, but not their slope.
RP_HD bool liesOn(const SurfaceSample& sample, const BackgroundPlane& plane, double tolerance_mm) {
  const double height = plane.heightOf(sample.point);
  return height <= tolerance_mm && height >= -tolerance_mm &&
         glm::dot(sample.normal, plane.normal) > kFlatTiltCos;
}

/// The plane through three samples; a wall stands on the floor. False where they lie on several
/// surfaces, as most triples do: their slopes give them away before anything is counted.
RP_HD bool planeThrough(const SurfaceSample (&three)[3],
                        bool orthographic,
                        double tolerance_mm,
                        const BackgroundPlane* floor,
                        BackgroundPlane& plane) {
  // A wall makes at least this angle with the floor: cos 50 degrees.
  constexpr double kMaxWallCos = 0.64;
  const glm::dvec3 normal =
      glm::cross(three[1].point - three[0].point, three[2].point - three[0].point);
  const double length = glm::length(normal);
  if (length < 1e-9) return false;
  plane = facingCamera(normal / length, three[0].point, orthographic);
  for (const SurfaceSample& sample : three) {
    if (!liesOn(sample, plane, tolerance_mm)) return false;
  }
  if (floor == nullptr) return true;
  const double cosine = glm::dot(plane.normal, floor->normal);
  return cosine <= kMaxWallCos && cosine >= -kMaxWallCos;
}

/// The direction in which points scatter least, by inverse iteration from the old normal.
RP_HD glm::dvec3 thinDirection(const glm::dmat3& covariance, glm::dvec3 normal) {
  const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
  const glm::dmat3 inverse = glm::inverse(covariance + glm::dmat3(1e-9 * trace + 1e-12));
  for (int i = 0; i < 8; ++i) normal = glm::normalize(inverse * normal);
  return normal;
}

enum class PlaneKind {
  kNothing,     ///< there is no further plane
  kFace,        ///< a part's, with nothing behind it
  kBackground,  ///< if enough stands out of it
};

/// Of a plane with `count` of all `total` samples on it, which scatter like that.
RP_HD PlaneKind kindOf(const glm::dmat3& covariance,
                       const glm::dvec3& normal,
                       double count,
                       double total,
                       bool is_floor,
                       const ForegroundOptions& options) {
  // Points of a part's face that is hidden in the middle are spread wider than the face's area.
  constexpr double kFaceInParts = 1.35;
  if (count < total * (is_floor ? options.min_floor_share : options.min_wall_share))
    return PlaneKind::kNothing;
  const PlaneExtent extent = extentInPlane(covariance, normal);
  if (extent.length_mm < kFaceInParts * options.flat_face.length_mm &&
      extent.width_mm < kFaceInParts * options.flat_face.width_mm)
    return PlaneKind::kFace;
  const bool large = extent.length_mm >= (is_floor ? 1.3 : 0.7) * options.part_mm &&
                     extent.width_mm >= (is_floor ? 0.4 : 0.25) * options.part_mm;
  return large ? PlaneKind::kBackground : PlaneKind::kNothing;
}

/// What is nearer to a background plane belongs to it [tolerances].
inline constexpr double kMarginTolerances = 1.5;

/// Whether a sample stands out of a plane.
RP_HD bool standsOut(const SurfaceSample& sample,
                     const BackgroundPlane& plane,
                     double tolerance_mm) {
  return plane.heightOf(sample.point) > 3.0 * tolerance_mm;
}

/// Whether a sample is looked at further after a plane was found: a sheet is no floor either, so
/// that walls are looked for beside; behind a background plane there is nothing.
RP_HD bool remains(const SurfaceSample& sample,
                   const BackgroundPlane& plane,
                   PlaneKind kind,
                   double tolerance_mm) {
  if (kind == PlaneKind::kFace) return !liesOn(sample, plane, tolerance_mm);
  return plane.heightOf(sample.point) > kMarginTolerances * tolerance_mm;
}

/// The bin, for points of the camera frame.
struct BinRule {
  bool given = false;  ///< whether the rest counts
  Pose bin_from_camera;
  glm::dvec3 inner_size_mm{0.0};
};

inline BinRule binRule(const std::optional<BinBox>& bin) {
  if (!bin) return {};
  return {true, bin->camera_from_bin.inverse(), bin->inner_size_mm};
}

/// In front of all planes and, if there is a bin, inside of it or above it, each by the margin.
RP_HD bool keeps(const BinRule& bin,
                 const BackgroundPlane* planes,
                 int count,
                 double tolerance_mm,
                 const glm::dvec3& point) {
  const double margin_mm = kMarginTolerances * tolerance_mm;
  for (int i = 0; i < count; ++i) {
    if (!(planes[i].heightOf(point) > margin_mm)) return false;
  }
  if (!bin.given) return true;
  const glm::dvec3 inside = bin.bin_from_camera * point;
  const glm::dvec3 half = 0.5 * bin.inner_size_mm - margin_mm;
  return inside.x < half.x && inside.x > -half.x && inside.y < half.y && inside.y > -half.y &&
         inside.z > margin_mm;
}

}  // namespace rangepose
