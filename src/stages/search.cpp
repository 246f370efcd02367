#include "stages/search.h"

#include <cmath>

#include "core/error.h"

namespace rangepose {

void SimplexOptions::check() const {
  RP_CHECK(step_px > 0.0f, "simplex step_px must be positive");
  RP_CHECK(spread >= 0.0f && spread < 2.0f, "simplex spread must lie in [0, 2)");
  RP_CHECK(max_iterations >= 1, "simplex max_iterations must be at least 1");
}

void ErrorOptions::check() const {
  RP_CHECK(lambda >= 0.0f && std::isfinite(lambda), "lambda must be finite and not negative");
  RP_CHECK(image_width_px >= 8, "image_width_px must be at least 8");
  RP_CHECK(range_limit_px > 0.0f, "range_limit_px must be positive");
  RP_CHECK(holes != HolePolicy::kLimit || std::isfinite(range_limit_px),
           "range_limit_px must be finite where holes count as much as it");
  RP_CHECK(row_step == 1 || row_step == 2, "row_step must be 1 or 2");
}

glm::vec3 startTranslation(const ReferenceObject& object, int view, float seed_range_px) {
  const ReferenceView& reference = object.views[static_cast<std::size_t>(view)];
  return startTranslation(reference.anchor_px, object.size, seed_range_px);
}

}  // namespace rangepose
