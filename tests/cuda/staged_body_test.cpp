// The bodies of the staged search, run on the host in lockstep over all views, against the host's
// search.
#include "cuda/staged_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cuda/search_scene.h"
#include "stages/search_host.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

/// The programs `errors of pixels` and `reduction` of one view.
ErrorTerms stagedTerms(const ReferenceObject& object,
                       int view,
                       const SceneChannels& window,
                       const cuda::SearchSetup& setup,
                       const SimplexPoint& at) {
  const int size = object.size;
  const glm::ivec2 origin = object.tileOrigin(view);
  Image<ErrorTerms> current(size, size);
  for (int v = 0; v < size; ++v) {
    for (int u = 0; u < size; ++u) {
      current.at(u, v) = cuda::stagedPixel(
          setup,
          -static_cast<float>(object.edt_passes + 1),
          object.atlas.at(origin.x + u, origin.y + v),
          u,
          v,
          at,
          [&](int x, int y) { return window.range_px.at(x, y); },
          [&](int x, int y) { return window.distance_px.at(x, y); });
    }
  }
  for (int level = 1; level <= cuda::lastLevel(size); ++level) {
    const int pitch = cuda::levelPitch(size, level);
    Image<ErrorTerms> next(pitch, pitch);
    for (int y = 0; y < pitch; ++y) {
      for (int x = 0; x < pitch; ++x) {
        next.at(x, y) = cuda::reducePixel(
            x, y, current.width(), [&](int px, int py) { return current.at(px, py); });
      }
    }
    current = next;
  }
  EXPECT_EQ(current.size(), 1U);
  return current.at(0, 0);
}

TEST(StagedBodyTest, SumsAreThoseOfTheHost) {
  for (const int size : {64, 33}) {
    const ReferenceObject object = test::renderedBracket(12, size, 21);
    const SceneChannels window = test::windowWith(object, 4, 3);
    const std::vector<glm::vec3> at = test::scatteredTranslations(object, 6);
    for (const auto& [holes, row_step] : {std::pair{HolePolicy::kPaper, 1},
                                          {HolePolicy::kIgnore, 1},
                                          {HolePolicy::kLimit, 1},
                                          {HolePolicy::kIgnore, 2}}) {
      SearchOptions options;
      options.error.holes = holes;
      options.error.row_step = row_step;
      const cuda::SearchSetup setup = cuda::searchSetup(object, window.range_px.width(), options);
      const std::vector<ErrorTerms> expected =
          host::errorTerms(object, host::PackedViews(object), window, at, options.error);
      for (std::size_t i = 0; i < at.size(); ++i) {
        const ErrorTerms terms = stagedTerms(
            object, static_cast<int>(i), window, setup, {at[i].x, at[i].y, at[i].z, 0.0f});
        const auto close = [&](float a, float b) {
          EXPECT_NEAR(a, b, test::kErrorSumRelative * std::abs(b) + test::kErrorSumPx) << i;
        };
        EXPECT_EQ(terms.cover_count, expected[i].cover_count);
        close(terms.cover_sum, expected[i].cover_sum);
        close(terms.range_sum, expected[i].range_sum);
        close(terms.range_weight, expected[i].range_weight);
      }
    }
  }
}

TEST(StagedBodyTest, TheLockstepFindsTheHostsErrors) {
  constexpr int kShown = 7;
  const ReferenceObject object = test::renderedBracket(24, 64, 31);
  const SceneChannels window = test::windowWith(object, kShown, 40);
  const SearchOptions options;
  const cuda::PackedViews packed = cuda::packViews(object);
  const cuda::SearchSetup setup = cuda::searchSetup(object, window.range_px.width(), options);
  const float seed = test::seedRange(window);
  const std::vector<Hypothesis> expected =
      host::search(object, host::PackedViews(object), {&window}, {seed}, options);
  int turned = 0;
  float best = kWorstError;
  int best_view = -1;
  for (int view = 0; view < 24; ++view) {
    const cuda::ViewEntry& entry = packed.entries[static_cast<std::size_t>(view)];
    SimplexState state = cuda::stagedStart(setup, entry, seed);
    int steps = 0;
    while (cuda::stagedStep(
        setup, entry, stagedTerms(object, view, window, setup, state.candidate), state)) {
      ASSERT_LT(++steps, 4 + 5 * options.simplex.max_iterations);
    }
    const float error = state.vertex[state.lowest].value;
    const float host_error = expected[static_cast<std::size_t>(view)].error;
    turned += std::abs(error - host_error) > 10.0f * test::kErrorSumRelative * host_error ? 1 : 0;
    if (error < best) {
      best = error;
      best_view = view;
    }
  }
  EXPECT_EQ(best_view, kShown);
  EXPECT_LE(turned, 2);
}

}  // namespace
}  // namespace rangepose
