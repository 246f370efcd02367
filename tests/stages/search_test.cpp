// The rough search on views pasted into scenes: what it must find, and with which sign.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "stages/channels_host.h"
#include "stages/reference_host.h"
#include "stages/search_host.h"
#include "stages/stage_set.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

constexpr float kSeedRange = 180.0f;

ReferenceObject renderedBracket(int views) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), views, 64, 23);
  host::renderReferences(object, {}, {});
  return object;
}

/// A window that shows one view, moved by `shift` from where the search starts, before a far floor.
SceneChannels windowWith(const ReferenceObject& object,
                         int view,
                         const glm::ivec3& shift,
                         float floor) {
  const int width = kWindowScale * object.size;
  Image<float> range(width, width, floor);
  const glm::vec3 anchor = object.views[static_cast<std::size_t>(view)].anchor_px;
  const glm::ivec2 origin = object.tileOrigin(view);
  for (int v = 0; v < object.size; ++v) {
    for (int u = 0; u < object.size; ++u) {
      const ReferenceTexel texel = object.atlas.at(origin.x + u, origin.y + v);
      const int x = width / 2 + u - static_cast<int>(anchor.x) + shift.x;
      const int y = width / 2 + v - static_cast<int>(anchor.y) + shift.y;
      if (texel.g == 0.0f || !range.contains(x, y)) continue;
      range.at(x, y) = texel.g - anchor.z + kSeedRange + static_cast<float>(shift.z);
    }
  }
  OrthoCamera camera;
  camera.width = width;
  camera.height = width;
  return host::channels(camera, range, {});
}

std::vector<Hypothesis> searchIn(const ReferenceObject& object, const SceneChannels& window) {
  return host::search(object, host::PackedViews(object), {&window}, {kSeedRange}, {});
}

const Hypothesis& bestOf(const std::vector<Hypothesis>& hypotheses) {
  return *std::min_element(
      hypotheses.begin(), hypotheses.end(), [](const Hypothesis& a, const Hypothesis& b) {
        return a.error < b.error;
      });
}

/// How far the simplex may stop from the best place [px]: x and y act by whole pixels, so that
/// between two of them it feels no slope and may end beside the minimum. A wrong sign would cost 6
/// px or more.
constexpr float kRoughPx = 5.0f;
/// What half of the searches reach [px].
constexpr float kRoughMedianPx = 1.0f;

TEST(SearchTest, AMovedViewIsFoundWhereItWasMovedTo) {
  const ReferenceObject object = renderedBracket(60);
  const glm::ivec3 shift(5, -3, 4);
  std::vector<float> misses;
  for (const float floor : {0.0f, 260.0f}) {
    for (int view = 0; view < 60; view += 4) {
      const Hypothesis found = bestOf(searchIn(object, windowWith(object, view, shift, floor)));
      EXPECT_EQ(found.view, view) << "another orientation than the one in the scene";
      const glm::vec3 expected = startTranslation(object, view, kSeedRange) + glm::vec3(shift);
      misses.push_back(glm::distance(found.translation_px, expected));
      EXPECT_LT(misses.back(), kRoughPx) << "view " << view;
    }
  }
  std::nth_element(misses.begin(),
                   misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2),
                   misses.end());
  EXPECT_LT(misses[misses.size() / 2], kRoughMedianPx);
}

TEST(SearchTest, EachDirectionHasItsOwnSign) {
  const ReferenceObject object = renderedBracket(60);
  for (const glm::ivec3 shift :
       {glm::ivec3(5, 0, 0), {-5, 0, 0}, {0, 5, 0}, {0, -5, 0}, {0, 0, 5}, {0, 0, -5}}) {
    const Hypothesis found = searchIn(object, windowWith(object, 11, shift, 0.0f))[11];
    const glm::vec3 moved = found.translation_px - startTranslation(object, 11, kSeedRange);
    EXPECT_LT(glm::distance(moved, glm::vec3(shift)), kRoughPx)
        << shift.x << ", " << shift.y << ", " << shift.z;
  }
}

TEST(SearchTest, TheErrorIsSmallestWhereTheViewWasPasted) {
  // Without the simplex: the convention of signs and of whole pixels, to the pixel.
  const ReferenceObject object = renderedBracket(12);
  const host::PackedViews packed(object);
  const glm::ivec3 shift(5, -3, 4);
  for (int view = 0; view < 12; ++view) {
    const SceneChannels window = windowWith(object, view, shift, 260.0f);
    const glm::vec3 pasted = startTranslation(object, view, kSeedRange) + glm::vec3(shift);
    const auto errorAt = [&](const glm::vec3& offset) {
      const std::vector<glm::vec3> at(12, pasted + offset);
      const auto terms = host::errorTerms(object, packed, window, at, {});
      return errorValue(terms[static_cast<std::size_t>(view)], ErrorOptions{}.lambdaPerPx(), 1.0f);
    };
    const float best = errorAt(glm::vec3(0.0f));
    EXPECT_EQ(errorAt({0.49f, -0.5f, 0.0f}), best) << "the same whole pixel";
    for (const glm::vec3 offset :
         {glm::vec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      EXPECT_GT(errorAt(offset), best)
          << "view " << view << ": " << offset.x << ", " << offset.y << ", " << offset.z;
    }
  }
}

TEST(SearchTest, TheErrorIsThatOfTheTranslationAndNotWorseThanTheStart) {
  const ReferenceObject object = renderedBracket(60);
  const SceneChannels window = windowWith(object, 5, {2, 6, -3}, 250.0f);
  const std::vector<Hypothesis> found = searchIn(object, window);
  const SearchOptions options;
  std::vector<glm::vec3> at;
  std::vector<glm::vec3> starts;
  for (const Hypothesis& hypothesis : found) {
    at.push_back(hypothesis.translation_px);
    starts.push_back(startTranslation(object, hypothesis.view, kSeedRange));
  }
  const host::PackedViews packed(object);
  const std::vector<ErrorTerms> reached =
      host::errorTerms(object, packed, window, at, options.error);
  const std::vector<ErrorTerms> started =
      host::errorTerms(object, packed, window, starts, options.error);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float area = areaFactor(options.error.area, object.views[i].area_px, object.maxArea());
    EXPECT_EQ(found[i].error, errorValue(reached[i], options.error.lambdaPerPx(), area));
    EXPECT_LE(found[i].error, errorValue(started[i], options.error.lambdaPerPx(), area));
    EXPECT_LE(found[i].iterations, options.simplex.max_iterations);
  }
}

TEST(SearchTest, HypothesesAreOrderedByWindowThenView) {
  const ReferenceObject object = renderedBracket(13);
  const SceneChannels first = windowWith(object, 2, {0, 0, 0}, 0.0f);
  const SceneChannels second = windowWith(object, 9, {0, 0, 0}, 0.0f);
  const host::PackedViews packed(object);
  const auto both = host::search(object, packed, {&first, &second}, {kSeedRange, kSeedRange}, {});
  ASSERT_EQ(both.size(), 26U);
  for (int i = 0; i < 26; ++i) {
    EXPECT_EQ(both[static_cast<std::size_t>(i)].window, i / 13);
    EXPECT_EQ(both[static_cast<std::size_t>(i)].view, i % 13);
  }
  const std::vector<Hypothesis> alone = searchIn(object, second);
  for (std::size_t i = 0; i < 13; ++i) {
    EXPECT_EQ(both[13 + i].translation_px, alone[i].translation_px)
        << "windows influence each other";
  }
}

TEST(SearchTest, TheNumberOfThreadsChangesNothing) {
  const ReferenceObject object = renderedBracket(200);
  const SceneChannels window = windowWith(object, 5, {2, 6, -3}, 250.0f);
  setThreadCount(1);
  const std::vector<Hypothesis> one = searchIn(object, window);
  setThreadCount(4);
  const std::vector<Hypothesis> four = searchIn(object, window);
  setThreadCount(0);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].translation_px, four[i].translation_px);
    ASSERT_EQ(one[i].error, four[i].error);
  }
}

TEST(SearchTest, AnEmptyViewOrSceneIsNeverTheBest) {
  ReferenceObject object = renderedBracket(4);
  const SceneChannels window = windowWith(object, 2, {0, 0, 0}, 0.0f);
  object.views[1].box = {};
  object.views[1].area_px = 0.0f;
  const std::vector<Hypothesis> found = searchIn(object, window);
  EXPECT_EQ(found[1].error, kWorstError);
  EXPECT_EQ(bestOf(found).view, 2);
}

TEST(SearchTest, StagesOfTheHostPathAreTheHostFunctions) {
  const ReferenceObject object = renderedBracket(9);
  const SceneChannels window = windowWith(object, 2, {1, 2, 3}, 0.0f);
  const std::unique_ptr<StageSet> stages = makeHostStages();
  const std::unique_ptr<ResidentScene> resident = stages->scenes->upload(window);
  EXPECT_EQ(resident->download().range_px, window.range_px);
  const auto found = stages->search->search(object, {resident.get()}, {kSeedRange}, {});
  const auto expected = searchIn(object, window);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(found[i].translation_px, expected[i].translation_px);
  EXPECT_EQ(stages->scenes->patches(*resident), host::patches(window.range_px, window.edges));
}

/// Otherwise a process that goes from one database to the next searches with the views of the
/// first.
TEST(SearchTest, AnotherObjectInTheSamePlaceIsSearchedWithItsOwnViews) {
  const std::unique_ptr<StageSet> stages = makeHostStages();
  ReferenceObject object = renderedBracket(9);
  const SceneChannels window = windowWith(object, 2, {1, 2, 3}, 0.0f);
  const std::unique_ptr<ResidentScene> resident = stages->scenes->upload(window);
  stages->search->search(object, {resident.get()}, {kSeedRange}, {});
  ReferenceObject other = renderedBracket(9);
  std::swap(other.views[0].rotation, other.views[2].rotation);
  host::renderReferences(other, {}, {});
  std::copy(other.atlas.begin(), other.atlas.end(), object.atlas.begin());
  other.atlas = std::move(object.atlas);  // the same memory, too
  object = std::move(other);
  const auto found = stages->search->search(object, {resident.get()}, {kSeedRange}, {});
  const auto expected = searchIn(object, window);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(found[i].translation_px, expected[i].translation_px) << "view " << i;
}

}  // namespace
}  // namespace rangepose
