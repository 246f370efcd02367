#include "cuda/packed_views.h"

#include <algorithm>

#include "core/error.h"

namespace rangepose::cuda {

PackedViews packViews(const ReferenceObject& object) {
  RP_CHECK(object.size > 0 && object.size < 65536, "object: tiles must be 1..65535 px wide");
  PackedViews packed;
  for (int index = 0; index < static_cast<int>(object.views.size()); ++index) {
    const ReferenceView& view = object.views[static_cast<std::size_t>(index)];
    const glm::ivec2 origin = object.tileOrigin(index);
    ViewEntry entry;
    entry.first = static_cast<int>(packed.pixels.size());
    entry.area_px = view.area_px;
    entry.anchor_px = view.anchor_px;
    const auto append = [&](int odd) {
      for (int v = view.box.y0 + (view.box.y0 % 2 == odd ? 0 : 1); v < view.box.y1; v += 2) {
        for (int u = view.box.x0; u < view.box.x1; ++u) {
          const ReferenceTexel& texel = object.atlas.at(origin.x + u, origin.y + v);
          if (texel.a <= 0.0f) continue;
          packed.pixels.push_back({texel.r, texel.g, texel.a, u + 65536 * v});
          ++entry.all.count;
          if (texel.r > 0.0f) entry.all.cover_count += 1.0f;
        }
      }
    };
    append(0);
    entry.even = entry.all;
    append(1);
    packed.most_pixels = std::max(packed.most_pixels, entry.all.count);
    packed.most_even_pixels = std::max(packed.most_even_pixels, entry.even.count);
    packed.entries.push_back(entry);
  }
  return packed;
}

SearchSetup searchSetup(const ReferenceObject& object,
                        int window_px,
                        const SearchOptions& options) {
  options.simplex.check();
  options.error.check();
  SearchSetup setup;
  setup.size = object.size;
  setup.views = static_cast<int>(object.views.size());
  setup.max_area_px = object.maxArea();
  setup.lambda_per_px = options.error.lambdaPerPx();
  setup.range = rangeRule(options.error.range_limit_px, options.error.holes);
  setup.area = options.error.area;
  setup.row_step = options.error.row_step;
  setup.simplex = options.simplex;
  setup.frame = windowFrame(window_px, object.size);
  return setup;
}

}  // namespace rangepose::cuda
