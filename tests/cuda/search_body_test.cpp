// The body of the fused search, run on the host, against the host's search.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "cuda/search_scene.h"
#include "stages/search_host.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

using cuda::kSearchThreads;
using test::FusedInput;

void expectNear(const ErrorTerms& actual, const ErrorTerms& expected, const std::string& where) {
  const auto close = [&](float a, float b) {
    EXPECT_NEAR(a, b, test::kErrorSumRelative * std::abs(b) + test::kErrorSumPx) << where;
  };
  close(actual.cover_sum, expected.cover_sum);
  EXPECT_EQ(actual.cover_count, expected.cover_count) << where;
  close(actual.range_sum, expected.range_sum);
  close(actual.range_weight, expected.range_weight);
}

TEST(SearchBodyTest, ViewsKeepEveryPixelOfTheObjectOnce) {
  const ReferenceObject object = test::renderedBracket(7, 48, 5);
  const cuda::PackedViews packed = cuda::packViews(object);
  ASSERT_EQ(packed.entries.size(), 7U);
  int most = 0;
  int most_even = 0;
  for (int view = 0; view < 7; ++view) {
    const cuda::ViewEntry& entry = packed.entries[static_cast<std::size_t>(view)];
    Image<int> seen(48, 48);
    for (int i = entry.first; i < entry.first + entry.all.count; ++i) {
      const cuda::ViewPixel& pixel = packed.pixels[static_cast<std::size_t>(i)];
      const int u = pixel.place % 65536;
      const int v = pixel.place / 65536;
      ++seen.at(u, v);
      EXPECT_EQ(i < entry.first + entry.even.count, v % 2 == 0) << "even rows come first";
      const glm::ivec2 at = object.tileOrigin(view) + glm::ivec2(u, v);
      EXPECT_EQ(glm::vec3(object.atlas.at(at.x, at.y).r,
                          object.atlas.at(at.x, at.y).g,
                          object.atlas.at(at.x, at.y).a),
                glm::vec3(pixel.distance, pixel.range, pixel.cosine));
    }
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 48; ++u) {
        const glm::ivec2 at = object.tileOrigin(view) + glm::ivec2(u, v);
        EXPECT_EQ(seen.at(u, v), object.atlas.at(at.x, at.y).a > 0.0f ? 1 : 0);
      }
    }
    most = std::max(most, entry.all.count);
    most_even = std::max(most_even, entry.even.count);
  }
  EXPECT_EQ(packed.most_pixels, most);
  EXPECT_EQ(packed.most_even_pixels, most_even);
}

TEST(SearchBodyTest, NoShiftReadsPastTheFrame) {
  for (const int size : {32, 33, 64, 128}) {
    for (const int width : {size, 2 * size, 3 * size}) {
      const cuda::WindowFrame frame = cuda::windowFrame(width, size);
      const int reach = static_cast<int>(std::floor(maxShiftPx(size) + 0.5f));
      EXPECT_GE(frame.origin - reach, 0) << size << ", " << width;
      EXPECT_LE(frame.origin + reach + size, frame.stride()) << size << ", " << width;
      EXPECT_EQ(frame.origin - frame.pad, (width - size) / 2);
    }
  }
}

TEST(SearchBodyTest, SumsAreThoseOfTheHost) {
  for (const int size : {64, 33}) {
    const ReferenceObject object = test::renderedBracket(30, size, 21);
    const SceneChannels window = test::windowWith(object, 4, 3);
    const std::vector<glm::vec3> at = test::scatteredTranslations(object, 6);
    for (const auto& [holes, row_step] : {std::pair{HolePolicy::kPaper, 1},
                                          {HolePolicy::kIgnore, 1},
                                          {HolePolicy::kLimit, 1},
                                          {HolePolicy::kIgnore, 2}}) {
      SearchOptions options;
      options.error.holes = holes;
      options.error.row_step = row_step;
      const FusedInput in(object, window, options);
      const std::vector<ErrorTerms> expected =
          host::errorTerms(object, host::PackedViews(object), window, at, options.error);
      const std::vector<ErrorTerms> actual = test::termsOnHost<0, kSearchThreads>(in, at);
      int outside = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i].cover_count == 0.0f) {
          // Out of reach: both must be worth the worst error, whatever else the sums say.
          EXPECT_EQ(errorValue(actual[i], 1.0f, 1.0f), kWorstError);
          ++outside;
          continue;
        }
        expectNear(
            actual[i], expected[i], "size " + std::to_string(size) + ", view " + std::to_string(i));
      }
      EXPECT_GT(outside, 0);
      EXPECT_LT(outside, 10);
    }
  }
}

TEST(SearchBodyTest, WherePixelsAreKeptChangesNoBit) {
  const ReferenceObject object = test::renderedBracket(12, 64, 21);
  const SceneChannels window = test::windowWith(object, 4, 3);
  const FusedInput in(object, window, {});
  ASSERT_LE(in.views.most_pixels, 6 * kSearchThreads) << "the slots must hold the views";
  const std::vector<glm::vec3> at = test::scatteredTranslations(object, 6);
  const std::vector<ErrorTerms> memory = test::termsOnHost<0, kSearchThreads>(in, at);
  const std::vector<ErrorTerms> six = test::termsOnHost<6, kSearchThreads>(in, at);
  const std::vector<ErrorTerms> twelve = test::termsOnHost<12, kSearchThreads>(in, at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_EQ(memory[i].cover_sum, six[i].cover_sum);
    EXPECT_EQ(memory[i].range_sum, six[i].range_sum);
    EXPECT_EQ(memory[i].range_weight, six[i].range_weight);
    EXPECT_EQ(six[i].range_sum, twelve[i].range_sum);
  }
}

/// The search of the host and the body's, in one window that shows view `shown`.
void compareSearches(const ReferenceObject& object, int shown, const SearchOptions& options) {
  const SceneChannels window = test::windowWith(object, shown, 40);
  const FusedInput in(object, window, options);
  const std::vector<Hypothesis> expected = host::search(
      object, host::PackedViews(object), {&window}, {test::seedRange(window)}, options);
  const std::vector<Hypothesis> actual = in.views.most_pixels <= 6 * kSearchThreads
                                             ? test::fusedOnHost<6, kSearchThreads>(in)
                                             : test::fusedOnHost<0, kSearchThreads>(in);
  ASSERT_EQ(actual.size(), expected.size());
  const auto before = [](const Hypothesis& a, const Hypothesis& b) { return a.error < b.error; };
  const Hypothesis& best = *std::min_element(actual.begin(), actual.end(), before);
  const Hypothesis& best_expected = *std::min_element(expected.begin(), expected.end(), before);
  EXPECT_EQ(best.view, shown) << "the view that is shown must win";
  EXPECT_NEAR(best.error, best_expected.error, test::kBestErrorRelative * best_expected.error);
  EXPECT_GT(best.iterations, 0);
  int turned = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const float gap = std::abs(actual[i].error - expected[i].error);
    turned += gap > 10.0f * test::kErrorSumRelative * expected[i].error ? 1 : 0;
  }
  EXPECT_LE(turned, static_cast<int>(test::kTurnedShare * static_cast<float>(actual.size())));
}

TEST(SearchBodyTest, TheWholeSearchFindsTheHostsErrors) {
  const ReferenceObject object = test::renderedBracket(60, 64, 31);
  for (const AreaFactor area : {AreaFactor::kIntended, AreaFactor::kNone}) {
    SearchOptions options;
    options.error.area = area;
    compareSearches(object, 7, options);
    compareSearches(object, 44, options);
  }
}

TEST(SearchBodyTest, ViewsTooLargeForRegistersAreSearchedToo) {
  const ReferenceObject object = test::renderedBracket(20, 128, 31);
  SearchOptions options;
  options.error.image_width_px = 128;
  compareSearches(object, 11, options);
}

TEST(SearchBodyTest, AnEmptyViewIsTheWorst) {
  ReferenceObject object = test::renderedBracket(3, 64, 31);
  object.views[1].box = {};
  object.views[1].area_px = 0.0f;
  const SceneChannels window = test::windowWith(object, 2, 40);
  const std::vector<Hypothesis> found =
      test::fusedOnHost<6, kSearchThreads>(FusedInput(object, window, {}));
  EXPECT_EQ(found[1].error, kWorstError);
  EXPECT_LT(found[2].error, 5.0f);
}

}  // namespace
}  // namespace rangepose
