#include "stages/search_host.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stages/lanes.h"

namespace rangepose::host {
namespace {

constexpr int kLanes = PackedViews::kLanes;
constexpr int kViewsPerPiece = 8;

/// A scene window with a frame of background wide enough that no shifted tile reads past it.
class PaddedWindow {
 public:
  PaddedWindow(const SceneChannels& window, int size, float background_distance)
      : window_width_(window.range_px.width()), margin_((window_width_ - size) / 2) {
    // The tile starts at margin + shift; whole vectors may reach past its right end.
    pad_ = std::max(0, static_cast<int>(std::ceil(maxShiftPx(size))) + 1 - margin_) + kLanes;
    const int padded = window_width_ + 2 * pad_;
    range_ = Image<float>(padded, padded, 0.0f);
    distance_ = Image<float>(padded, padded, background_distance);
    for (int y = 0; y < window_width_; ++y) {
      std::copy_n(window.range_px.row(y), window_width_, range_.row(y + pad_) + pad_);
      std::copy_n(window.distance_px.row(y), window_width_, distance_.row(y + pad_) + pad_);
    }
  }

  int stride() const { return range_.width(); }
  /// Where the tile's pixel (0, 0) falls for a shift of whole pixels.
  int origin(int shift_x, int shift_y) const {
    return (pad_ + margin_ + shift_y) * stride() + pad_ + margin_ + shift_x;
  }
  const float* range() const { return range_.data(); }
  const float* distance() const { return distance_.data(); }

 private:
  int window_width_;
  int margin_;
  int pad_ = 0;
  Image<float> range_;
  Image<float> distance_;
};

/// What the inner loop reads: plain pointers and numbers.
struct Evaluation {
  const PackedViews::Block* blocks;
  std::size_t block_count;
  const float* reference_distance;
  const float* reference_range;
  const float* reference_cosine;
  const float* scene_distance;  ///< at the tile's pixel (0, 0)
  const float* scene_range;
  int stride;
  float shift_z;
  float cover_count;
  float range_weight;
  RangeRule rule;
};

/// Sums of Eq. 3 and 5; the weights are those of the pixels that count.
RP_SIMD_CLONES ErrorTerms sumErrors(const Evaluation& e) {
  Float8 cover{};
  Float8 range{};
  Float8 kept{};
  for (std::size_t i = 0; i < e.block_count; ++i) {
    const PackedViews::Block& block = e.blocks[i];
    const int at = block.v * e.stride + block.u;
    const auto terms = errorOfPixel<Float8>(load8(e.reference_distance + block.offset),
                                            load8(e.reference_cosine + block.offset),
                                            load8(e.reference_range + block.offset) + e.shift_z,
                                            load8(e.scene_distance + at),
                                            load8(e.scene_range + at),
                                            e.rule);
    cover += terms.cover_sum;
    range += terms.range_sum;
    kept += terms.range_weight;
  }
  // What is kept is added up, not what is lost taken away: over nothing but holes it must be
  // exactly 0.
  const float weight = e.rule.hole_weight == 0.0f ? sum8(kept) : e.range_weight;
  return {sum8(cover), e.cover_count, sum8(range), weight};
}

ErrorTerms termsAt(const PackedViews& packed,
                   int view_index,
                   int size,
                   const PaddedWindow& window,
                   const glm::vec3& translation,
                   const ErrorOptions& options) {
  const float reach = maxShiftPx(size);
  // Written so that a NaN is outside too.
  if (!(std::abs(translation.x) <= reach && std::abs(translation.y) <= reach)) return {};
  const PackedViews::Rows& rows = packed.rows(view_index, options.row_step);
  const int origin = window.origin(static_cast<int>(std::floor(translation.x + 0.5f)),
                                   static_cast<int>(std::floor(translation.y + 0.5f)));
  const Evaluation evaluation = {rows.blocks.data(),
                                 rows.blocks.size(),
                                 packed.distance(),
                                 packed.range(),
                                 packed.cosine(),
                                 window.distance() + origin,
                                 window.range() + origin,
                                 window.stride(),
                                 translation.z - static_cast<float>(size),
                                 rows.cover_count,
                                 rows.range_weight,
                                 rangeRule(options.range_limit_px, options.holes)};
  return sumErrors(evaluation);
}

float backgroundDistance(const ReferenceObject& object) {
  return -static_cast<float>(object.edt_passes + 1);
}

}  // namespace

namespace {

void append(PackedViews::Rows& rows, const PackedViews::Rows& more) {
  rows.blocks.insert(rows.blocks.end(), more.blocks.begin(), more.blocks.end());
  rows.cover_count += more.cover_count;
  rows.range_weight += more.range_weight;
}

}  // namespace

PackedViews::PackedViews(const ReferenceObject& object) {
  for (int index = 0; index < static_cast<int>(object.views.size()); ++index) pack(object, index);
}

void PackedViews::pack(const ReferenceObject& object, int index) {
  const PixelBox box = object.views[static_cast<std::size_t>(index)].box;
  const glm::ivec2 origin = object.tileOrigin(index);
  Rows& all = all_.emplace_back();
  Rows& every_other = every_other_.emplace_back();
  for (int v = box.y0; v < box.y1; ++v) {
    const ReferenceTexel* texels = object.atlas.row(origin.y + v) + origin.x;
    int first = box.x0;
    int last = box.x1 - 1;
    while (first <= last && texels[first].a == 0.0f) ++first;
    while (last >= first && texels[last].a == 0.0f) --last;
    if (first > last) continue;
    const int count = (last - first + kLanes) / kLanes * kLanes;
    Rows row;
    for (int u = first; u < first + count; ++u) {
      if ((u - first) % kLanes == 0)
        row.blocks.push_back({u, v, static_cast<int>(distance_.size())});
      const ReferenceTexel texel = u <= last ? texels[u] : ReferenceTexel(0.0f);
      const bool shown = texel.a > 0.0f;
      distance_.push_back(shown ? texel.r : 0.0f);
      range_.push_back(shown ? texel.g : 0.0f);
      cosine_.push_back(shown ? texel.a : 0.0f);
      if (shown && texel.r > 0.0f) row.cover_count += 1.0f;
      row.range_weight += shown ? texel.a : 0.0f;
    }
    append(all, row);
    if (v % 2 == 0) append(every_other, row);
  }
}

std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                   const PackedViews& packed,
                                   const SceneChannels& window,
                                   const std::vector<glm::vec3>& translations_px,
                                   const ErrorOptions& options) {
  options.check();
  RP_CHECK(translations_px.size() == object.views.size(), "one translation a view is needed");
  const PaddedWindow padded(window, object.size, backgroundDistance(object));
  std::vector<ErrorTerms> terms(object.views.size());
  parallelFor(static_cast<int>(terms.size()), kViewsPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      terms[at] = termsAt(packed, i, object.size, padded, translations_px[at], options);
    }
  });
  return terms;
}

std::vector<Hypothesis> search(const ReferenceObject& object,
                               const PackedViews& packed,
                               const std::vector<const SceneChannels*>& windows,
                               const std::vector<float>& seed_range_px,
                               const SearchOptions& options) {
  options.simplex.check();
  options.error.check();
  RP_CHECK(windows.size() == seed_range_px.size(), "one seed range a window is needed");
  const int view_count = static_cast<int>(object.views.size());
  const float max_area = object.maxArea();
  const float lambda = options.error.lambdaPerPx();
  std::vector<Hypothesis> hypotheses(windows.size() * object.views.size());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const PaddedWindow window(*windows[w], object.size, backgroundDistance(object));
    parallelFor(view_count, kViewsPerPiece, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const ReferenceView& view = object.views[static_cast<std::size_t>(i)];
        const float area = areaFactor(options.error.area, view.area_px, max_area);
        const glm::vec3 start = startTranslation(object, i, seed_range_px[w]);
        SimplexState state = simplexStart(start.x, start.y, start.z, options.simplex.step_px);
        while (state.phase != static_cast<int>(SimplexPhase::kDone)) {
          const glm::vec3 at(state.candidate.x, state.candidate.y, state.candidate.z);
          const ErrorTerms terms = termsAt(packed, i, object.size, window, at, options.error);
          state = simplexStep(state,
                              errorValue(terms, lambda, area),
                              options.simplex.spread,
                              options.simplex.max_iterations);
        }
        const SimplexPoint& best = state.vertex[state.lowest];
        hypotheses[w * object.views.size() + static_cast<std::size_t>(i)] = {
            i, static_cast<int>(w), {best.x, best.y, best.z}, best.value, state.iterations};
      }
    });
  }
  return hypotheses;
}

}  // namespace rangepose::host
