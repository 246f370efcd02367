// The image error (paper Eq. 1-6) against a plain double-precision sum.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "stages/channels_host.h"
#include "stages/reference_host.h"
#include "stages/search_host.h"
#include "support/box_mesh.h"
#include "support/oracle.h"
#include "support/range_scenes.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

namespace oracle = test::oracle;
using test::Random;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr HolePolicy kPolicies[] = {HolePolicy::kPaper, HolePolicy::kIgnore, HolePolicy::kLimit};

ReferenceObject renderedBracket(int views, int size) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), views, size, 17);
  host::renderReferences(object, {}, {});
  return object;
}

SceneChannels windowOf(int width, unsigned seed) {
  OrthoCamera camera;
  camera.width = width;
  camera.height = width;
  return host::channels(camera, test::randomBlobs(width, width, seed), {});
}

void expectTerms(const ErrorTerms& actual,
                 const oracle::Terms& expected,
                 const std::string& where) {
  const auto near = [&](float value, double oracle_value) {
    EXPECT_NEAR(value, oracle_value, test::kErrorSumRelative * oracle_value + test::kErrorSumPx)
        << where;
  };
  near(actual.cover_sum, expected.cover_sum);
  EXPECT_EQ(static_cast<double>(actual.cover_count), expected.cover_count) << where;
  near(actual.range_sum, expected.range_sum);
  near(actual.range_weight, expected.range_weight);
}

TEST(ErrorTest, SumsAreThoseOfThePaper) {
  for (const int size : {64, 48, 33}) {
    const ReferenceObject object = renderedBracket(21, size);
    const host::PackedViews packed(object);
    Random random(static_cast<unsigned>(size));
    for (const HolePolicy holes : kPolicies) {
      for (const auto& [limit, row_step] : {std::pair{8.0f, 1}, {1.5f, 1}, {8.0f, 2}}) {
        const SceneChannels window = windowOf(2 * size, 3);
        ErrorOptions options;
        options.holes = holes;
        options.range_limit_px = limit;
        options.row_step = row_step;
        std::vector<glm::vec3> at;
        at.reserve(21);
        for (int i = 0; i < 21; ++i) {
          at.emplace_back(random.uniform(-0.76, 0.76) * size,
                          random.uniform(-0.76, 0.76) * size,
                          random.uniform(50.0, 150.0));
        }
        at[0] = {0.5f, -0.5f, 100.0f};
        at[1] = {-0.5f, 1.49f, 100.0f};
        const std::vector<ErrorTerms> terms = host::errorTerms(object, packed, window, at, options);
        for (int view = 0; view < 21; ++view) {
          const std::size_t i = static_cast<std::size_t>(view);
          const double background = -(object.edt_passes + 1.0);
          expectTerms(terms[i],
                      oracle::errorTerms(object, view, window, at[i], options, background),
                      "size " + std::to_string(size) + ", holes " +
                          std::to_string(static_cast<int>(holes)) + ", rows " +
                          std::to_string(row_step) + ", view " + std::to_string(view));
        }
      }
    }
  }
}

TEST(ErrorTest, WithoutALimitRangesCountInFullAsPrinted) {
  const ReferenceObject object = renderedBracket(3, 64);
  const SceneChannels window = windowOf(128, 5);
  ErrorOptions options;
  options.range_limit_px = kInfinity;
  options.holes = HolePolicy::kPaper;
  const std::vector<glm::vec3> at(3, {3.0f, -4.0f, 20.0f});
  const host::PackedViews packed(object);
  const std::vector<ErrorTerms> terms = host::errorTerms(object, packed, window, at, options);
  for (int view = 0; view < 3; ++view) {
    const std::size_t i = static_cast<std::size_t>(view);
    expectTerms(
        terms[i], oracle::errorTerms(object, view, window, at[i], options, -8.0), "no limit");
  }
}

TEST(ErrorTest, AShiftOutOfReachIsTheWorst) {
  const ReferenceObject object = renderedBracket(6, 64);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<glm::vec3> at = {{48.5f, 0, 90},
                                     {0, -48.1f, 90},
                                     {nan, 0, 90},
                                     {0, nan, 90},
                                     {1e30f, 0, 90},
                                     {48.0f, -48.0f, 90}};
  const host::PackedViews packed(object);
  const std::vector<ErrorTerms> terms = host::errorTerms(object, packed, windowOf(128, 6), at, {});
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(errorValue(terms[i], 0.3f, 2.0f), kWorstError) << i;
  EXPECT_LT(errorValue(terms[5], 0.3f, 2.0f), kWorstError) << "the reach itself is allowed";
}

TEST(ErrorTest, NothingButHolesCannotBeComparedWhenHolesAreIgnored) {
  // The weight left must be exactly 0: rounding noise in its place would make an empty place a good
  // match.
  const ReferenceObject object = renderedBracket(40, 64);
  OrthoCamera camera;
  camera.width = 128;
  camera.height = 128;
  const SceneChannels window = host::channels(camera, Image<float>(128, 128, 0.0f), {});
  ErrorOptions options;
  options.holes = HolePolicy::kIgnore;
  const std::vector<glm::vec3> at(40, {0.0f, 0.0f, 100.0f});
  for (const ErrorTerms& terms :
       host::errorTerms(object, host::PackedViews(object), window, at, options)) {
    EXPECT_EQ(terms.range_weight, 0.0f);
    EXPECT_EQ(errorValue(terms, 0.3f, 1.0f), kWorstError);
  }
}

TEST(ErrorTest, ValueIsEquationOne) {
  const ErrorTerms terms = {30.0f, 10.0f, 8.0f, 16.0f};
  EXPECT_FLOAT_EQ(errorValue(terms, 0.25f, 2.0f), 2.0f * (3.0f + 0.25f * 0.5f));
  EXPECT_EQ(errorValue({1.0f, 0.0f, 1.0f, 1.0f}, 0.25f, 2.0f), kWorstError);
  EXPECT_EQ(errorValue({1.0f, 1.0f, 1.0f, 0.0f}, 0.25f, 2.0f), kWorstError);
  ErrorOptions options;
  EXPECT_FLOAT_EQ(options.lambdaPerPx(), 20.0f / 64.0f);
}

TEST(ErrorTest, OnePixelOfEachKind) {
  const auto pixel = [](float distance, float cosine, float seen, HolePolicy holes) {
    return errorOfPixel(distance, cosine, 100.0f, 2.0f, seen, rangeRule(8.0f, holes));
  };
  for (const HolePolicy holes : kPolicies) {
    const ErrorTerms same = pixel(5.0f, 0.5f, 103.0f, holes);
    EXPECT_EQ(same.cover_sum, 3.0f);
    EXPECT_EQ(same.range_sum, 1.5f);
    EXPECT_EQ(same.range_weight, 0.5f);
    EXPECT_EQ(pixel(5.0f, 0.5f, 300.0f, holes).range_sum, 4.0f) << "limited";
    EXPECT_EQ(pixel(0.0f, 0.5f, 103.0f, holes).cover_count, 0.0f) << "f is 0 on edges";
    EXPECT_EQ(pixel(-3.0f, 0.0f, 103.0f, holes).range_weight, 0.0f)
        << "background of the reference";
  }
  EXPECT_EQ(pixel(5.0f, 0.5f, 0.0f, HolePolicy::kPaper).range_sum, 0.0f);
  EXPECT_EQ(pixel(5.0f, 0.5f, 0.0f, HolePolicy::kPaper).range_weight, 0.5f);
  EXPECT_EQ(pixel(5.0f, 0.5f, 0.0f, HolePolicy::kIgnore).range_weight, 0.0f);
  EXPECT_EQ(pixel(5.0f, 0.5f, 0.0f, HolePolicy::kLimit).range_sum, 4.0f);
}

TEST(ErrorTest, AreaFactorsFavourAsTheyPromise) {
  EXPECT_EQ(areaFactor(AreaFactor::kNone, 100.0f, 400.0f), 1.0f);
  EXPECT_EQ(areaFactor(AreaFactor::kIntended, 100.0f, 400.0f), 4.0f);
  EXPECT_EQ(areaFactor(AreaFactor::kRoot, 100.0f, 400.0f), 2.0f);
  EXPECT_EQ(areaFactor(AreaFactor::kAsPrinted, 100.0f, 400.0f), 0.25f);
  for (const AreaFactor form :
       {AreaFactor::kNone, AreaFactor::kIntended, AreaFactor::kRoot, AreaFactor::kAsPrinted}) {
    EXPECT_EQ(areaFactor(form, 400.0f, 400.0f), 1.0f);
    EXPECT_TRUE(std::isfinite(areaFactor(form, 0.0f, 400.0f))) << "an empty view";
  }
}

}  // namespace
}  // namespace rangepose
