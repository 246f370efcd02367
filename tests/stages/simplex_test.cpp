// The downhill simplex as a state machine against known minima and against a textbook version.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/glm.h"
#include "stages/simplex_core.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using Function = std::function<float(const glm::vec3&)>;

struct Outcome {
  glm::vec3 at{0.0f};
  float value = 0.0f;
  float start_value = 0.0f;
  int iterations = 0;
  int calls = 0;
};

Outcome minimise(const Function& function, const glm::vec3& start, const SimplexOptions& options) {
  SimplexState state = simplexStart(start.x, start.y, start.z, options.step_px);
  Outcome outcome;
  outcome.start_value = function(start);
  // Each iteration evaluates at most a reflection, a contraction and three shrunk vertices.
  const int limit = 4 + 5 * options.max_iterations;
  while (state.phase != static_cast<int>(SimplexPhase::kDone) && outcome.calls <= limit) {
    const glm::vec3 at(state.candidate.x, state.candidate.y, state.candidate.z);
    state = simplexStep(state, function(at), options.spread, options.max_iterations);
    ++outcome.calls;
  }
  EXPECT_LE(outcome.calls, limit) << "the search does not end";
  const SimplexPoint& best = state.vertex[state.lowest];
  outcome.at = {best.x, best.y, best.z};
  outcome.value = best.value;
  outcome.iterations = state.iterations;
  return outcome;
}

/// Nelder and Mead 1965, with their coefficients 1, 2, 1/2, on a sorted simplex.
Outcome textbook(const Function& function, const glm::vec3& start, const SimplexOptions& options) {
  struct Vertex {
    glm::vec3 at;
    float value;
  };
  const auto at = [&](const glm::vec3& point) { return Vertex{point, function(point)}; };
  std::array<Vertex, 4> simplex = {at(start), at(start), at(start), at(start)};
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 corner = start;
    corner[axis] += options.step_px;
    simplex[static_cast<std::size_t>(axis) + 1] = at(corner);
  }
  Outcome outcome;
  for (;; ++outcome.iterations) {
    std::stable_sort(simplex.begin(), simplex.end(), [](const Vertex& a, const Vertex& b) {
      return a.value < b.value;
    });
    Vertex& worst = simplex[3];
    const float high = worst.value;
    const float low = simplex[0].value;
    if (2.0f * (high - low) <= options.spread * (high + low)) break;
    if (outcome.iterations == options.max_iterations) break;
    const glm::vec3 centroid = (simplex[0].at + simplex[1].at + simplex[2].at) / 3.0f;
    const Vertex reflected = at(2.0f * centroid - worst.at);
    if (reflected.value < low) {
      const Vertex expanded = at(3.0f * centroid - 2.0f * worst.at);
      worst = expanded.value < reflected.value ? expanded : reflected;
      continue;
    }
    if (reflected.value < simplex[2].value) {
      worst = reflected;
      continue;
    }
    if (reflected.value < worst.value) worst = reflected;
    const Vertex contracted = at(0.5f * (centroid + worst.at));
    if (contracted.value < worst.value) {
      worst = contracted;
      continue;
    }
    for (std::size_t i = 1; i < 4; ++i) simplex[i] = at(0.5f * (simplex[0].at + simplex[i].at));
  }
  outcome.at = simplex[0].at;
  outcome.value = simplex[0].value;
  return outcome;
}

float bowl(const glm::vec3& p) {
  return 1.0f + (p.x - 3.0f) * (p.x - 3.0f) + 2.0f * (p.y + 5.0f) * (p.y + 5.0f) +
         0.5f * (p.z - 1.0f) * (p.z - 1.0f) + 0.3f * (p.x - 3.0f) * (p.y + 5.0f);
}

/// A bent valley: Rosenbrock's along x and y, and a slope of its own in z.
float valley(const glm::vec3& p) {
  const float bend = p.y - 0.1f * p.x * p.x;
  return 1e-3f + (p.x - 5.0f) * (p.x - 5.0f) + 30.0f * bend * bend + (p.z - p.y) * (p.z - p.y);
}

SimplexOptions toTheEnd() {
  SimplexOptions options;
  options.spread = 0.0f;
  options.max_iterations = 400;
  return options;
}

TEST(SimplexTest, FindsTheBottomOfABowl) {
  const Outcome found = minimise(bowl, {0.0f, 0.0f, 0.0f}, toTheEnd());
  EXPECT_LT(glm::distance(found.at, glm::vec3(3.0f, -5.0f, 1.0f)), 0.01f);
  EXPECT_NEAR(found.value, 1.0f, 1e-5f);
}

TEST(SimplexTest, FollowsABentValley) {
  const Outcome found = minimise(valley, {-6.0f, 4.0f, -3.0f}, toTheEnd());
  EXPECT_LT(glm::distance(found.at, glm::vec3(5.0f, 2.5f, 2.5f)), 0.02f);
  EXPECT_NEAR(found.value, 1e-3f, 1e-4f);
}

TEST(SimplexTest, ThePapersSettingsComeNearInThirtyIterations) {
  // 5 % spread of the error (Sect. 6.3): good enough for a start of the refinement.
  SimplexOptions options;
  options.spread = 0.05f;
  const Outcome found = minimise(bowl, {0.0f, 0.0f, 0.0f}, options);
  EXPECT_LE(found.iterations, 30);
  EXPECT_LT(found.value, 1.1f);
}

TEST(SimplexTest, NeverReturnsWorseThanTheStartAndAlwaysEnds) {
  test::Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const double frequency = random.uniform(0.1, 5.0);
    const double phase = random.uniform(0.0, 6.0);
    const Function rough = [=](const glm::vec3& p) {
      const double wave = std::sin(frequency * p.x + phase) * std::cos(1.7 * frequency * p.y) +
                          std::sin(frequency * p.z);
      return static_cast<float>(2.0 + wave + (std::floor(p.x) > 7.0f ? 1e6 : 0.0));
    };
    const glm::vec3 start(random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-8, 8));
    SimplexOptions options;
    options.spread = trial % 2 == 0 ? 0.0f : 0.05f;
    const Outcome found = minimise(rough, start, options);
    EXPECT_LE(found.value, found.start_value);
    EXPECT_EQ(found.value, rough(found.at)) << "the answer is not where its value was measured";
    EXPECT_LE(found.iterations, options.max_iterations);
  }
}

TEST(SimplexTest, EqualErrorsEverywhereEndAtOnce) {
  for (const float value : {0.0f, 1.0f, 1e6f}) {
    const Outcome found = minimise([=](const glm::vec3&) { return value; }, {1, 2, 3}, toTheEnd());
    EXPECT_EQ(found.calls, 4);
    EXPECT_EQ(found.at, glm::vec3(1, 2, 3)) << "on a tie the start wins";
  }
}

TEST(SimplexTest, NotANumberDoesNotHangIt) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  minimise([=](const glm::vec3&) { return nan; }, {1, 2, 3}, toTheEnd());
}

TEST(SimplexTest, DoneStaysDone) {
  SimplexState state = simplexStart(1, 2, 3, 2);
  for (int i = 0; i < 4; ++i) state = simplexStep(state, 5.0f, 0.05f, 40);
  ASSERT_EQ(state.phase, static_cast<int>(SimplexPhase::kDone));
  const SimplexState after = simplexStep(state, 1.0f, 0.05f, 40);
  EXPECT_EQ(after.phase, state.phase);
  EXPECT_EQ(after.vertex[after.lowest].value, 5.0f);
}

TEST(SimplexTest, StartsAlongTheThreeAxes) {
  SimplexState state = simplexStart(1, 2, 3, 2);
  const glm::vec3 expected[4] = {{1, 2, 3}, {3, 2, 3}, {1, 4, 3}, {1, 2, 5}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(glm::vec3(state.candidate.x, state.candidate.y, state.candidate.z), expected[i]);
    state = simplexStep(state, static_cast<float>(10 + i), 0.05f, 40);
  }
}

TEST(SimplexTest, GoesTheWayOfTheTextbook) {
  test::Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const glm::vec3 middle(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-6, 6));
    const glm::vec3 weight(random.uniform(0.2, 3), random.uniform(0.2, 3), random.uniform(0.2, 3));
    const float mixed = static_cast<float>(random.uniform(-0.3, 0.3));
    const Function function = [=](const glm::vec3& p) {
      const glm::vec3 d = p - middle;
      return 0.5f + glm::dot(weight, d * d) + mixed * d.x * d.y * d.z / (1.0f + glm::dot(d, d));
    };
    SimplexOptions options;
    options.spread = 0.01f;
    const Outcome expected = textbook(function, glm::vec3(0.0f), options);
    const Outcome actual = minimise(function, glm::vec3(0.0f), options);
    EXPECT_EQ(actual.iterations, expected.iterations) << trial;
    EXPECT_NEAR(actual.value, expected.value, 1e-3f * expected.value) << trial;
    EXPECT_LT(glm::distance(actual.at, expected.at), 1e-3f) << trial;
  }
}

}  // namespace
}  // namespace rangepose
