// What a thread does in the three programs of the staged search (paper Sect. 6.3): the sums of one
// pixel, one pixel of a reduction, one step of a simplex. See block.h.
#pragma once

#include <cmath>

#include "cuda/block.h"
#include "cuda/search_types.h"

namespace rangepose::cuda {

/// Width of a tile whose texels hold the sums of 2^level x 2^level pixels.
RP_HD int levelPitch(int size, int level) { return (size + (1 << level) - 1) >> level; }

/// Of the first level whose tiles are one texel.
RP_HD int lastLevel(int size) {
  int level = 0;
  while (levelPitch(size, level) > 1) ++level;
  return level;
}

/// The sums of Eq. 2 for pixel (u, v) of a tile, whose texel is `reference`, with the view at
/// `at`. `range(x, y)` and `distance(x, y)` read the window.
template <typename Range, typename Distance>
RP_BODY ErrorTerms stagedPixel(const SearchSetup& setup,
                               float outside_distance,
                               const ReferenceTexel& reference,
                               int u,
                               int v,
                               const SimplexPoint& at,
                               const Range& range,
                               const Distance& distance) {
  const float reach = maxShiftPx(setup.size);
  // Written so that a NaN is outside too.
  const bool reachable = at.x >= -reach && at.x <= reach && at.y >= -reach && at.y <= reach;
  if (!reachable || reference.a <= 0.0f || v % setup.row_step != 0) return {};
  const int width = setup.frame.width;
  const int margin = setup.frame.origin - setup.frame.pad;
  const int x = u + margin + static_cast<int>(std::floor(at.x + 0.5f));
  const int y = v + margin + static_cast<int>(std::floor(at.y + 0.5f));
  const bool inside = x >= 0 && y >= 0 && x < width && y < width;
  return errorOfPixel(reference.r,
                      reference.a,
                      reference.g + (at.z - static_cast<float>(setup.size)),
                      inside ? distance(x, y) : outside_distance,
                      inside ? range(x, y) : 0.0f,
                      setup.range);
}

RP_BODY ErrorTerms added(const ErrorTerms& a, const ErrorTerms& b) {
  return {a.cover_sum + b.cover_sum,
          a.cover_count + b.cover_count,
          a.range_sum + b.range_sum,
          a.range_weight + b.range_weight};
}

/// One texel of the log-step reduction (paper Fig. 9): four of the level before. `previous(x, y)`
/// reads a tile of that level, `pitch` texels wide. The targets shrink, as in glsl/reduce.frag,
/// which adds sixteen.
template <typename Previous>
RP_BODY ErrorTerms reducePixel(int x, int y, int pitch, const Previous& previous) {
  const bool right = 2 * x + 1 < pitch;
  const bool below = 2 * y + 1 < pitch;
  ErrorTerms sum = previous(2 * x, 2 * y);
  if (right) sum = added(sum, previous(2 * x + 1, 2 * y));
  if (below) sum = added(sum, previous(2 * x, 2 * y + 1));
  if (right && below) sum = added(sum, previous(2 * x + 1, 2 * y + 1));
  return sum;
}

RP_BODY SimplexState stagedStart(const SearchSetup& setup,
                                 const ViewEntry& view,
                                 float seed_range_px) {
  const glm::vec3 start = startTranslation(view.anchor_px, setup.size, seed_range_px);
  return simplexStart(start.x, start.y, start.z, setup.simplex.step_px);
}

/// False once the simplex is done.
RP_BODY bool stagedStep(const SearchSetup& setup,
                        const ViewEntry& view,
                        const ErrorTerms& terms,
                        SimplexState& state) {
  const float area = areaFactor(setup.area, view.area_px, setup.max_area_px);
  simplexAdvance(state,
                 errorValue(terms, setup.lambda_per_px, area),
                 setup.simplex.spread,
                 setup.simplex.max_iterations);
  return state.phase != static_cast<int>(SimplexPhase::kDone);
}

}  // namespace rangepose::cuda
