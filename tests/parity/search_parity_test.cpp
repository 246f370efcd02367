// Error sums, simplex steps and the whole search.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gles/references_gles.h"
#include "parity/parity_fixture.h"
#include "stages/channels_host.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

class SearchParity : public test::Parity {};
RP_PARITY_SUBJECTS(SearchParity);
using test::Random;

SceneChannels channelsOf(const Image<float>& range) {
  OrthoCamera camera;
  camera.width = range.width();
  camera.height = range.height();
  return host::channels(camera, range, {});
}

/// A window that shows a view with its anchor at the centre, in front of a few other surfaces.
SceneChannels windowWith(const ReferenceObject& object,
                         int view,
                         float shift_range,
                         unsigned seed) {
  const int width = kWindowScale * object.size;
  Image<float> range = test::randomBlobs(width, width, seed);
  for (float& value : range) value = value == 0.0f ? 0.0f : value + 200.0f;
  const glm::vec3 anchor = object.views[static_cast<std::size_t>(view)].anchor_px;
  const glm::ivec2 origin = object.tileOrigin(view);
  for (int v = 0; v < object.size; ++v) {
    for (int u = 0; u < object.size; ++u) {
      const ReferenceTexel texel = object.atlas.at(origin.x + u, origin.y + v);
      const int x = width / 2 + u - static_cast<int>(anchor.x);
      const int y = width / 2 + v - static_cast<int>(anchor.y);
      if (texel.a > 0.0f && range.contains(x, y)) range.at(x, y) = texel.g + shift_range;
    }
  }
  return channelsOf(range);
}

void expectNear(const ErrorTerms& actual, const ErrorTerms& expected, const std::string& where) {
  const auto close = [&](float a, float b) {
    EXPECT_NEAR(a, b, test::kErrorSumRelative * std::abs(b) + test::kErrorSumPx) << where;
  };
  close(actual.cover_sum, expected.cover_sum);
  EXPECT_EQ(actual.cover_count, expected.cover_count) << where;
  close(actual.range_sum, expected.range_sum);
  close(actual.range_weight, expected.range_weight);
}

TEST_P(SearchParity, ErrorSumsAgree) {
  // Both paths know an object by its address, so the two must live side by side.
  std::array<ReferenceObject, 2> objects = {test::objectOf(test::bracketBoxes(), 30, 64, 21),
                                            test::objectOf(test::bracketBoxes(), 30, 33, 22)};
  for (ReferenceObject& object : objects) {
    const int size = object.size;
    renderReferences(object);
    const SceneChannels window = windowWith(object, 4, 57.0f, 3);
    Random random(6);
    for (const auto& [holes, row_step] : {std::pair{HolePolicy::kPaper, 1},
                                          {HolePolicy::kIgnore, 1},
                                          {HolePolicy::kLimit, 1},
                                          {HolePolicy::kIgnore, 2}}) {
      ErrorOptions options;
      options.holes = holes;
      options.row_step = row_step;
      std::vector<glm::vec3> translations;
      translations.reserve(30);
      for (int i = 0; i < 30; ++i) {
        // Some beyond the largest shift, some that read past the window.
        translations.emplace_back(random.uniform(-0.8, 0.8) * size,
                                  random.uniform(-0.8, 0.8) * size,
                                  random.uniform(40.0, 80.0) + size);
      }
      translations[0] = {-0.5f, 0.5f, 57.0f};
      const std::vector<ErrorTerms> expected =
          host().probe->errorTerms(object, window, translations, options);
      const std::vector<ErrorTerms> actual =
          subject().probe->errorTerms(object, window, translations, options);
      ASSERT_EQ(actual.size(), expected.size());
      int counted = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        expectNear(actual[i],
                   expected[i],
                   "size " + std::to_string(size) + ", holes " +
                       std::to_string(static_cast<int>(holes)) + ", view " + std::to_string(i));
        counted += expected[i].cover_count > 0.0f ? 1 : 0;
      }
      EXPECT_GT(counted, 20);
      EXPECT_LT(counted, 30) << "no translation lies outside";
    }
  }
}

TEST_P(SearchParity, AShiftIsWorthTheWorstErrorJustBeyondItsLimit) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 2, 64, 21);
  renderReferences(object);
  const SceneChannels window = windowWith(object, 0, 57.0f, 3);
  const std::vector<glm::vec3> edge = {{48.0f, -48.0f, 100.0f}, {48.001f, 0.0f, 100.0f}};
  const std::vector<ErrorTerms> terms = subject().probe->errorTerms(object, window, edge, {});
  EXPECT_GT(terms[0].cover_count, 0.0f);
  EXPECT_EQ(terms[1].cover_count, 0.0f);
  EXPECT_EQ(errorValue(terms[1], 1.0f, 1.0f), kWorstError);
}

std::int64_t farthest(const SimplexPoint& a, const SimplexPoint& b) {
  return std::max({test::ulpsBetween(a.x, b.x),
                   test::ulpsBetween(a.y, b.y),
                   test::ulpsBetween(a.z, b.z),
                   test::ulpsBetween(a.value, b.value)});
}

std::int64_t farthest(const SimplexState& a, const SimplexState& b) {
  std::int64_t ulps =
      std::max(farthest(a.reflected, b.reflected), farthest(a.candidate, b.candidate));
  for (int i = 0; i < 4; ++i) ulps = std::max(ulps, farthest(a.vertex[i], b.vertex[i]));
  return ulps;
}

TEST_P(SearchParity, ReplayedSimplexStepsAreExact) {
  const std::int64_t allowed = deviceUlps();
  constexpr int kCount = 333;
  Random random(12);
  SimplexOptions options;
  options.spread = 0.001f;
  std::vector<SimplexState> states;
  std::vector<glm::vec3> minima;
  const auto anywhere = [&] { return static_cast<float>(random.uniform(-20.0, 20.0)); };
  for (int i = 0; i < kCount; ++i) {
    states.push_back(simplexStart(anywhere(), anywhere(), anywhere(), options.step_px));
    minima.emplace_back(anywhere(), anywhere(), anywhere());
  }
  std::vector<int> seen(static_cast<std::size_t>(SimplexPhase::kDone) + 1, 0);
  for (int step = 0; step < 204; ++step) {
    std::vector<float> values;
    for (int i = 0; i < kCount; ++i) {
      const std::size_t at = static_cast<std::size_t>(i);
      const SimplexPoint& c = states[at].candidate;
      const glm::vec3 gap = glm::vec3(c.x, c.y, c.z) - minima[at];
      // A bowl with bumps, so that every branch is taken; some values are equal.
      const float bumps = i % 3 == 0 ? 0.0f : static_cast<float>(random.uniform(0.0, 30.0));
      values.push_back(i % 50 == 0 ? 4.0f : glm::dot(gap, gap) + bumps + 0.01f);
      ++seen[static_cast<std::size_t>(states[at].phase)];
    }
    const std::vector<SimplexState> expected = host().probe->simplexSteps(states, values, options);
    const std::vector<SimplexState> actual = subject().probe->simplexSteps(states, values, options);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(actual[i].phase, expected[i].phase) << "step " << step << ", state " << i;
      ASSERT_EQ(actual[i].iterations, expected[i].iterations);
      ASSERT_EQ(actual[i].highest, expected[i].highest);
      ASSERT_EQ(actual[i].lowest, expected[i].lowest);
      ASSERT_LE(farthest(actual[i], expected[i]), allowed) << "step " << step << ", state " << i;
    }
    states = expected;
  }
  for (std::size_t phase = 0; phase < seen.size(); ++phase) {
    EXPECT_GT(seen[phase], 0) << "phase " << phase << " was never replayed";
  }
  for (const SimplexState& state : states)
    EXPECT_EQ(state.phase, static_cast<int>(SimplexPhase::kDone));
}

const Hypothesis& best(const std::vector<Hypothesis>& all, int window) {
  const Hypothesis* found = nullptr;
  for (const Hypothesis& h : all) {
    if (h.window == window && (found == nullptr || h.error < found->error)) found = &h;
  }
  return *found;
}

TEST_P(SearchParity, TheWholeSearchFindsTheSameErrors) {
  constexpr int kViews = 60;
  ReferenceObject object = test::objectOf(test::bracketBoxes(), kViews, 64, 31);
  renderReferences(object);
  const std::vector<int> shown = {7, 44};
  std::vector<std::unique_ptr<ResidentScene>> on_host;
  std::vector<std::unique_ptr<ResidentScene>> on_device;
  std::vector<float> seeds;
  for (const int view : shown) {
    const SceneChannels window = windowWith(object, view, 20.0f + static_cast<float>(view), 40);
    seeds.push_back(window.range_px.at(64, 64));
    on_host.push_back(host().scenes->upload(window));
    on_device.push_back(subject().scenes->upload(window));
  }
  const auto pointers = [](const auto& scenes) {
    std::vector<const ResidentScene*> result;
    result.reserve(scenes.size());
    for (const auto& scene : scenes) result.push_back(scene.get());
    return result;
  };
  for (const AreaFactor area : {AreaFactor::kRoot, AreaFactor::kNone}) {
    SearchOptions options;
    options.error.area = area;
    const std::vector<Hypothesis> expected =
        host().search->search(object, pointers(on_host), seeds, options);
    const std::vector<Hypothesis> actual =
        subject().search->search(object, pointers(on_device), seeds, options);
    ASSERT_EQ(actual.size(), 2U * kViews);
    ASSERT_EQ(expected.size(), actual.size());
    int turned = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(actual[i].view, expected[i].view);
      ASSERT_EQ(actual[i].window, expected[i].window);
      const float gap = std::abs(actual[i].error - expected[i].error);
      turned += gap > 10.0f * test::kErrorSumRelative * expected[i].error ? 1 : 0;
    }
    EXPECT_LE(turned, static_cast<int>(test::kTurnedShare * static_cast<float>(actual.size())));
    for (int window = 0; window < 2; ++window) {
      const Hypothesis& there = best(actual, window);
      EXPECT_EQ(there.view, shown[static_cast<std::size_t>(window)])
          << "the view that is shown must win";
      EXPECT_NEAR(there.error,
                  best(expected, window).error,
                  test::kBestErrorRelative * best(expected, window).error);
      EXPECT_GT(there.iterations, 0);
    }
  }
}

TEST_P(SearchParity, TheSameSearchTwiceIsBitIdentical) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 20, 64, 31);
  renderReferences(object);
  const SceneChannels window = windowWith(object, 3, 30.0f, 1);
  const std::unique_ptr<ResidentScene> scene = subject().scenes->upload(window);
  const std::vector<float> seed = {window.range_px.at(64, 64)};
  const std::vector<Hypothesis> first = subject().search->search(object, {scene.get()}, seed, {});
  const std::vector<Hypothesis> second = subject().search->search(object, {scene.get()}, seed, {});
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].error, second[i].error);
    EXPECT_EQ(first[i].translation_px, second[i].translation_px);
  }
}

TEST_P(SearchParity, AWindowMayBeSearchedTwiceInOneCall) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 5, 64, 31);
  renderReferences(object);
  const SceneChannels window = windowWith(object, 2, 30.0f, 1);
  const std::unique_ptr<ResidentScene> scene = subject().scenes->upload(window);
  const float seed = window.range_px.at(64, 64);
  const std::vector<Hypothesis> found =
      subject().search->search(object, {scene.get(), scene.get()}, {seed, seed}, {});
  const std::size_t views = object.views.size();
  ASSERT_EQ(found.size(), 2 * views);
  for (std::size_t i = 0; i < views; ++i) EXPECT_EQ(found[i].error, found[i + views].error);
}

TEST_P(SearchParity, ScenesOfAnotherPathAreRefused) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 2, 64, 31);
  renderReferences(object);
  const SceneChannels window = windowWith(object, 0, 30.0f, 1);
  const std::unique_ptr<ResidentScene> scene = host().scenes->upload(window);
  EXPECT_THROW(subject().search->search(object, {scene.get()}, {90.0f}, {}), Error);
  static_cast<void>(subject().probe->median(window.range_px));  // for the fixture's proof of work
}

}  // namespace
}  // namespace rangepose
