// The image error of one reference view at one translation (paper Sect. 6.2, Eq. 1-6).
// Twins: glsl/error_pixel.frag, glsl/error_value (in glsl/common/).
#pragma once

#include <cmath>

#include "core/host_device.h"
#include "stages/lanes.h"

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

/// Larger than any difference of ranges in an image [px].
inline constexpr float kNoRangeLimit = 1.0e9f;

struct ErrorOptions {
  /// Weight of E_range, for ranges as a fraction of the image width (paper: 20). With ranges in
  /// pixels that is lambda / image_width_px per pixel: 0.31 at 64 px.
  float lambda = 20.0f;
  int image_width_px = 64;  ///< width of a reference image [px]
  float range_limit_px =
      8.0f;  ///< range differences count at most this much [px]; in the paper without limit
  AreaFactor area = AreaFactor::kIntended;
  HolePolicy holes = HolePolicy::kIgnore;
  /// 1, or 2: only every other row of a view is summed, the first one of its tile included.
  int row_step = 1;
  float lambdaPerPx() const { return lambda / static_cast<float>(image_width_px); }
  void check() const;
};

/// The four sums of Eq. 2, kept apart until the end so that back-ends can be compared before they
/// are divided. Layout of an RGBA32F texel.
template <typename V>
struct ErrorTermsOf {
  V cover_sum{};     ///< sum f |EDT_I - EDT_R| [px]
  V cover_count{};   ///< sum f
  V range_sum{};     ///< sum c d [px]
  V range_weight{};  ///< sum c
};
using ErrorTerms = ErrorTermsOf<float>;

/// Error of a translation at which nothing can be compared (outside of the window).
inline constexpr float kWorstError = 1.0e6f;

/// What ErrorOptions say about a pixel's range, as numbers.
struct RangeRule {
  float limit;        ///< range differences count at most this much [px]
  float hole_gap;     ///< difference over a hole [px]
  float hole_weight;  ///< factor of the weight over a hole
};

RP_HD RangeRule rangeRule(float range_limit, HolePolicy holes) {
  return {range_limit,
          holes == HolePolicy::kLimit ? range_limit : 0.0f,
          holes == HolePolicy::kIgnore ? 0.0f : 1.0f};
}

/// One reference pixel (V = float) or eight (Float8) against those of the scene, Eq. 3 to 6.
/// `reference_*` as in ReferenceTexel, the cosine not negative; `predicted` is the range that the
/// reference has after the translation [px]. Without branches: the innermost loop of the search.
template <typename V>
RP_LANES ErrorTermsOf<V> errorOfPixel(const V& reference_distance,
                                      const V& reference_cos,
                                      const V& predicted,
                                      const V& scene_distance,
                                      const V& scene_range,
                                      const RangeRule& rule) {
  const auto covers = reference_distance > 0.0f;
  const auto hole = scene_range == 0.0f;
  const V aside = magnitude(scene_distance - reference_distance);
  const V off = smaller(magnitude(scene_range - predicted), all<V>(rule.limit));
  const V gap = pick(hole, all<V>(rule.hole_gap), off);
  const V weight = pick(hole, reference_cos * rule.hole_weight, reference_cos);
  return {pick(covers, aside, V{}), pick(covers, all<V>(1.0f), V{}), weight * gap, weight};
}

/// r_i of Eq. 1.
RP_HD float areaFactor(AreaFactor form, float area_px, float max_area_px) {
  const float ratio = max_area_px / (area_px < 1.0f ? 1.0f : area_px);
  switch (form) {
    case AreaFactor::kNone:
      return 1.0f;
    case AreaFactor::kIntended:
      return ratio;
    case AreaFactor::kRoot:
      return std::sqrt(ratio);
    case AreaFactor::kAsPrinted:
      return 1.0f / ratio;
  }
  return 1.0f;
}

/// Eq. 1 from the sums; `area_factor` is r_i.
RP_HD float errorValue(const ErrorTerms& terms, float lambda_per_px, float area_factor) {
  if (terms.cover_count <= 0.0f || terms.range_weight <= 0.0f) return kWorstError;
  return area_factor * (terms.cover_sum / terms.cover_count +
                        lambda_per_px * terms.range_sum / terms.range_weight);
}

}  // namespace rangepose
