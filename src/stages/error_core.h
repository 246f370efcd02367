// The image error of one reference view at one translation (paper Sect. 6.2, Eq. 1-6).
// Twins: glsl/error_pixel.frag, glsl/error_value (in glsl/common/).
#pragma once

#include "stages/device.h"

namespace rangepose {

/// Pixels of a reference tile that are added up per evaluation are shifted over the scene window by
/// whole pixels: a shift x reads the window at column u + margin + floor(x + 0.5).
///
/// Sign: moving the object by (+x, +y) in the image reads the scene at (u + x, v + y), where (u, v)
/// is the reference's own pixel. The paper sums over scene pixels and reads the reference instead.

/// Which factor favours views that show much of the object (the r_i of Eq. 1).
enum class AreaFactor : int {
  kNone = 0,       ///< 1
  kIntended = 1,   ///< A_max / A_i: a small view has a larger error
  kRoot = 2,       ///< sqrt(A_max / A_i)
  kAsPrinted = 3,  ///< A_i / A_max, as printed in the paper: it does the opposite of its text
};

/// How pixels of the reference over missing scene range enter E_range.
enum class HolePolicy : int {
  kPaper = 0,   ///< difference 0, weight counted (Eq. 5 as printed)
  kIgnore = 1,  ///< neither difference nor weight
  kLimit = 2,   ///< difference range_limit_px: a hole is as bad as the worst surface
};

struct ErrorOptions {
  /// Weight of E_range, for ranges as a fraction of the image width (paper: 20). With ranges in
  /// pixels that is lambda / image_width_px per pixel: 0.31 at 64 px.
  float lambda = 20.0f;
  int image_width_px = 64;  ///< width of a reference image [px]
  float range_limit_px =
      8.0f;  ///< range differences count at most this much [px]; infinite in the paper
  AreaFactor area = AreaFactor::kIntended;
  HolePolicy holes = HolePolicy::kIgnore;
  float lambdaPerPx() const { return lambda / static_cast<float>(image_width_px); }
  void check() const;
};

/// The four sums of Eq. 2, kept apart until the end so that back-ends can be compared before they
/// are divided. Layout of an RGBA32F texel.
struct ErrorTerms {
  float cover_sum = 0.0f;     ///< sum f |EDT_I - EDT_R| [px]
  float cover_count = 0.0f;   ///< sum f
  float range_sum = 0.0f;     ///< sum c d [px]
  float range_weight = 0.0f;  ///< sum c
};

/// Error of a translation at which nothing can be compared (outside of the window).
inline constexpr float kWorstError = 1.0e6f;

/// One reference pixel against one scene pixel. `reference_*` as in ReferenceTexel; `predicted` is
/// the range that the reference has after the translation [px].
RP_HD ErrorTerms errorOfPixel(float reference_distance,
                              float reference_cos,
                              float predicted,
                              float scene_distance,
                              float scene_range,
                              float range_limit,
                              HolePolicy holes) {
  ErrorTerms terms{};
  if (reference_distance > 0.0f) {
    const float gap = scene_distance - reference_distance;
    terms.cover_sum = gap < 0.0f ? -gap : gap;
    terms.cover_count = 1.0f;
  }
  if (reference_cos > 0.0f) {
    float gap = scene_range - predicted;
    if (gap < 0.0f) gap = -gap;
    if (gap > range_limit) gap = range_limit;
    float weight = reference_cos;
    if (scene_range == 0.0f) {
      if (holes == HolePolicy::kPaper) gap = 0.0f;
      if (holes == HolePolicy::kIgnore) weight = 0.0f;
      if (holes == HolePolicy::kLimit) gap = range_limit;
    }
    terms.range_sum = weight * gap;
    terms.range_weight = weight;
  }
  return terms;
}

/// Eq. 1 from the sums; `area_factor` is r_i.
RP_HD float errorValue(const ErrorTerms& terms, float lambda_per_px, float area_factor) {
  if (terms.cover_count <= 0.0f || terms.range_weight <= 0.0f) return kWorstError;
  return area_factor * (terms.cover_sum / terms.cover_count +
                        lambda_per_px * terms.range_sum / terms.range_weight);
}

}  // namespace rangepose
