// The nearest known surface at each pixel of an image: all parts whose poses are known, rendered
// together.
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

/// A part of an image.
struct KnownPart {
  const Mesh* mesh = nullptr;  ///< must outlive the part
  double diameter_mm = 0.0;
  Pose camera_from_object;
  bool counted = true;  ///< false: it only hides others
};

struct KnownPixel {
  int part = -1;           ///< index into the parts; -1 where nothing is known
  float depth_mm = 0.0f;   ///< along z
  glm::vec3 normal{0.0f};  ///< unit length, in the camera frame, towards the camera
  float cosine = 0.0f;     ///< of the angle between the normal and the ray, 0..1
  int inside_px = 0;       ///< from there to the nearest pixel beside a contour or a jump of the
                           ///< known depth: the larger of columns and rows between them

  bool inner() const;
};

using KnownSurface = Image<KnownPixel>;

/// Pixels nearer to a contour or a jump are not compared.
inline constexpr int kInnerPx = 3;
/// Further inside than this what a sensor makes of jumps is not seen any more.
inline constexpr int kDeepPx = 9;

inline bool KnownPixel::inner() const { return part >= 0 && inside_px >= kInnerPx; }

/// A measurement this far from the surface, along its normal, may still be one of it [mm].
double agreementMm(const KnownPart& part);

/// Depth 1 mm farther along the ray of a pixel moves its point by this [mm].
glm::dvec3 rayOf(const Camera& camera, int u, int v);

/// Of the size of the camera's image.
KnownSurface renderKnown(const std::vector<KnownPart>& parts, const Camera& camera);

}  // namespace rangepose
