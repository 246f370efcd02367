// The fused and the staged search on the device: against their bodies run on the host (bit for bit)
// and against the host's search (within the tolerances of other orders of sums).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cuda/cuda_fixture.h"
#include "cuda/search.h"
#include "cuda/search_scene.h"
#include "cuda/staged_search.h"
#include "stages/search_host.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

using cuda::kSearchThreads;
using test::FusedInput;

class SearchGpuTest : public test::CudaFixture {
 protected:
  /// The window with its frame, made on the device.
  cuda::Buffer<cuda::WindowTexel> framedOnDevice(const SceneChannels& window,
                                                 const FusedInput& in,
                                                 float outside_distance) {
    const cuda::Array range = toDevice(window.range_px);
    const cuda::Array distance = toDevice(window.distance_px);
    cuda::Buffer<cuda::WindowTexel> texels(static_cast<std::size_t>(in.setup.frame.texels()));
    cuda::frameWindow(
        range.view(), distance.view(), outside_distance, in.setup.frame, texels.data(), stream());
    RP_CUDA(cudaStreamSynchronize(stream()));  // the arrays end here
    return texels;
  }

  std::vector<Hypothesis> fused(const ReferenceObject& object, const FusedInput& in) {
    const cuda::ResidentObject resident(object, stream());
    const cuda::Buffer<cuda::WindowTexel> windows = toDevice(in.texels);
    const cuda::Buffer<float> seeds = toDevice(std::vector<float>{in.seed_range_px});
    const cuda::Buffer<Hypothesis> answers(object.views.size());
    cuda::search(resident, in.setup, windows.data(), seeds.data(), 1, answers.data(), stream());
    return answers.download(answers.size(), stream());
  }

  std::vector<ErrorTerms> fusedTerms(const ReferenceObject& object,
                                     const FusedInput& in,
                                     const std::vector<glm::vec3>& at) {
    const cuda::ResidentObject resident(object, stream());
    const cuda::Buffer<cuda::WindowTexel> window = toDevice(in.texels);
    const cuda::Buffer<glm::vec3> translations = toDevice(at);
    const cuda::Buffer<ErrorTerms> terms(at.size());
    cuda::errorTerms(
        resident, in.setup, window.data(), translations.data(), terms.data(), stream());
    return terms.download(terms.size(), stream());
  }

  std::vector<Hypothesis> staged(const ReferenceObject& object,
                                 const FusedInput& in,
                                 const SceneChannels& window) {
    const cuda::ResidentObject resident(object, stream());
    const cuda::Array atlas = toDevice(object.atlas);
    const cuda::Array range = toDevice(window.range_px);
    const cuda::Array distance = toDevice(window.distance_px);
    const cuda::StagedInput input{resident, atlas.view(), range.view(), distance.view(), in.setup};
    cuda::StagedSearch search(static_cast<int>(object.views.size()), object.size);
    const cuda::Buffer<Hypothesis> answers(object.views.size());
    search.search(input, in.seed_range_px, 0, answers.data(), stream());
    return answers.download(answers.size(), stream());
  }
};

bool same(const ErrorTerms& a, const ErrorTerms& b) {
  return a.cover_sum == b.cover_sum && a.cover_count == b.cover_count &&
         a.range_sum == b.range_sum && a.range_weight == b.range_weight;
}

int differences(const std::vector<ErrorTerms>& a, const std::vector<ErrorTerms>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += same(a[i], b[i]) ? 0 : 1;
  return count;
}

void expectSame(const std::vector<Hypothesis>& actual, const std::vector<Hypothesis>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(actual[i].view, expected[i].view);
    EXPECT_EQ(actual[i].error, expected[i].error) << "view " << i;
    EXPECT_EQ(actual[i].translation_px, expected[i].translation_px) << "view " << i;
    EXPECT_EQ(actual[i].iterations, expected[i].iterations) << "view " << i;
  }
}

void expectLikeHost(const std::vector<Hypothesis>& actual,
                    const std::vector<Hypothesis>& expected,
                    int shown) {
  ASSERT_EQ(actual.size(), expected.size());
  const auto before = [](const Hypothesis& a, const Hypothesis& b) { return a.error < b.error; };
  const Hypothesis& best = *std::min_element(actual.begin(), actual.end(), before);
  const Hypothesis& host_best = *std::min_element(expected.begin(), expected.end(), before);
  EXPECT_EQ(best.view, shown);
  EXPECT_NEAR(best.error, host_best.error, test::kBestErrorRelative * host_best.error);
  int turned = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const float gap = std::abs(actual[i].error - expected[i].error);
    turned += gap > 10.0f * test::kErrorSumRelative * expected[i].error ? 1 : 0;
  }
  EXPECT_LE(turned, static_cast<int>(test::kTurnedShare * static_cast<float>(actual.size())));
}

TEST_F(SearchGpuTest, FramesAreTheHosts) {
  const ReferenceObject object = test::renderedBracket(1, 33, 21);
  const SceneChannels window = test::windowWith(object, 0, 3);
  const FusedInput in(object, window, {});
  const auto texels = framedOnDevice(window, in, -static_cast<float>(object.edt_passes + 1));
  const std::vector<cuda::WindowTexel> actual = texels.download(texels.size(), stream());
  ASSERT_EQ(actual.size(), in.texels.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_EQ(actual[i].range, in.texels[i].range) << i;
    ASSERT_EQ(actual[i].distance, in.texels[i].distance) << i;
  }
}

TEST_F(SearchGpuTest, SumsAreThoseOfTheBody) {
  const ReferenceObject object = test::renderedBracket(30, 64, 21);
  const SceneChannels window = test::windowWith(object, 4, 3);
  const std::vector<glm::vec3> at = test::scatteredTranslations(object, 6);
  for (const HolePolicy holes : {HolePolicy::kPaper, HolePolicy::kIgnore, HolePolicy::kLimit}) {
    SearchOptions options;
    options.error.holes = holes;
    options.error.row_step = holes == HolePolicy::kIgnore ? 2 : 1;
    const FusedInput in(object, window, options);
    EXPECT_EQ(differences(fusedTerms(object, in, at), test::termsOnHost<0, kSearchThreads>(in, at)),
              0);
  }
}

/// The comparison above must be able to fail.
TEST_F(SearchGpuTest, AWindowOffByOnePixelIsNoticed) {
  const ReferenceObject object = test::renderedBracket(30, 64, 21);
  const FusedInput in(object, test::windowWith(object, 4, 3), {});
  FusedInput wrong = in;
  ++wrong.setup.frame.origin;
  const std::vector<glm::vec3> at = test::scatteredTranslations(object, 6);
  EXPECT_GT(
      differences(fusedTerms(object, wrong, at), test::termsOnHost<0, kSearchThreads>(in, at)), 15);
}

TEST_F(SearchGpuTest, TheFusedSearchIsItsBodyAndLikeTheHost) {
  std::set<int> slots;  // pixels in so many registers, or in none
  for (const int size : {48, 64, 96, 128}) {
    const ReferenceObject object = test::renderedBracket(40, size, 31);
    const SceneChannels window = test::windowWith(object, 11, 40);
    SearchOptions options;
    options.error.image_width_px = size;
    const FusedInput in(object, window, options);
    const std::vector<Hypothesis> actual = fused(object, in);
    expectSame(actual, test::fusedOnHost<0, kSearchThreads>(in));
    expectLikeHost(
        actual,
        host::search(
            object, host::PackedViews(object), {&window}, {test::seedRange(window)}, options),
        11);
    expectSame(fused(object, in), actual);  // twice
    slots.insert(cuda::searchSlots(in.views.most_pixels));
  }
  EXPECT_EQ(slots, (std::set<int>{0, 3, 6, 12}));
}

TEST_F(SearchGpuTest, WindowsDoNotInfluenceEachOther) {
  const ReferenceObject object = test::renderedBracket(20, 64, 31);
  const FusedInput first(object, test::windowWith(object, 3, 40), {});
  const FusedInput second(object, test::windowWith(object, 15, 41), {});
  std::vector<cuda::WindowTexel> both = first.texels;
  both.insert(both.end(), second.texels.begin(), second.texels.end());
  const cuda::ResidentObject resident(object, stream());
  const cuda::Buffer<cuda::WindowTexel> windows = toDevice(both);
  const cuda::Buffer<float> seeds =
      toDevice(std::vector<float>{first.seed_range_px, second.seed_range_px});
  const cuda::Buffer<Hypothesis> answers(40);
  cuda::search(resident, first.setup, windows.data(), seeds.data(), 2, answers.data(), stream());
  const std::vector<Hypothesis> all = answers.download(40, stream());
  expectSame({all.begin(), all.begin() + 20}, test::fusedOnHost<0, kSearchThreads>(first));
  expectSame({all.begin() + 20, all.end()}, test::fusedOnHost<0, kSearchThreads>(second));
}

TEST_F(SearchGpuTest, TheStagedSearchIsLikeTheHost) {
  for (const int size : {64, 33}) {
    const ReferenceObject object = test::renderedBracket(40, size, 31);
    const SceneChannels window = test::windowWith(object, 11, 40);
    SearchOptions options;
    options.error.image_width_px = size;
    const FusedInput in(object, window, options);
    expectLikeHost(
        staged(object, in, window),
        host::search(
            object, host::PackedViews(object), {&window}, {test::seedRange(window)}, options),
        11);
  }
}

TEST_F(SearchGpuTest, ReplayedSimplexStepsAreExact) {
  constexpr int kCount = 100;
  test::Random random(12);
  SimplexOptions options;
  options.spread = 0.001f;
  std::vector<SimplexState> states;
  for (int i = 0; i < kCount; ++i) {
    const auto anywhere = [&] { return static_cast<float>(random.uniform(-20.0, 20.0)); };
    states.push_back(simplexStart(anywhere(), anywhere(), anywhere(), options.step_px));
  }
  for (int step = 0; step < 60; ++step) {
    std::vector<float> values;
    for (int i = 0; i < kCount; ++i) {
      const SimplexPoint& at = states[static_cast<std::size_t>(i)].candidate;
      const float bumps = static_cast<float>(random.uniform(0.0, 30.0));
      values.push_back(at.x * at.x + at.y * at.y + at.z * at.z + (i % 3 == 0 ? 0.0f : bumps));
    }
    const cuda::Buffer<SimplexState> on_device = toDevice(states);
    const cuda::Buffer<float> given = toDevice(values);
    cuda::simplexSteps(on_device.data(), given.data(), kCount, options, stream());
    const std::vector<SimplexState> actual = on_device.download(kCount, stream());
    for (std::size_t i = 0; i < kCount; ++i) {
      simplexAdvance(states[i], values[i], options.spread, options.max_iterations);
      ASSERT_EQ(actual[i].phase, states[i].phase) << "step " << step << ", state " << i;
      ASSERT_EQ(actual[i].candidate.x, states[i].candidate.x);
      ASSERT_EQ(actual[i].candidate.y, states[i].candidate.y);
      ASSERT_EQ(actual[i].candidate.z, states[i].candidate.z);
    }
  }
}

}  // namespace
}  // namespace rangepose
