// The normal equations of a refinement step against numeric differentiation and elimination.
#include "stages/icp_core.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/pose.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::Random;
using Step = std::array<double, 6>;

struct Pair {
  glm::dvec3 model;
  glm::dvec3 normal;
  glm::dvec3 scene;
  double weight;
};

std::vector<Pair> randomPairs(Random& random, int count) {
  const auto vector = [&](double size) {
    return glm::dvec3(
        random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  std::vector<Pair> pairs;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 model = vector(1.0);
    pairs.push_back({model,
                     glm::normalize(vector(1.0) + glm::dvec3(0, 0, 1.5)),
                     model + vector(0.1),
                     random.uniform(0.1, 1.0)});
  }
  return pairs;
}

IcpSums sumsOf(const std::vector<Pair>& pairs, double slide) {
  IcpSums sums{};
  for (const Pair& p : pairs) {
    addPair<double>(sums,
                    {p.model.x, p.model.y, p.model.z},
                    {p.normal.x, p.normal.y, p.normal.z},
                    {p.scene.x, p.scene.y, p.scene.z},
                    p.weight,
                    slide);
  }
  return sums;
}

/// What a step is to make small: weighted squares of the distances that are left when the scene
/// moves back by it, along the normals and, by the share `slide`, in all directions.
double cost(const std::vector<Pair>& pairs, const Step& step, double slide) {
  const glm::dmat3 turn = rotationFromVector({-step[0], -step[1], -step[2]});
  double sum = 0.0;
  for (const Pair& p : pairs) {
    const glm::dvec3 gap = turn * p.scene - glm::dvec3(step[3], step[4], step[5]) - p.model;
    const double along = glm::dot(p.normal, gap);
    sum += p.weight * (along * along + slide * glm::dot(gap, gap));
  }
  return sum;
}

Step along(int axis, double length) {
  Step step{};
  step[static_cast<std::size_t>(axis)] = length;
  return step;
}

TEST(IcpCoreTest, GradientIsTheSlopeOfTheCost) {
  Random random(1);
  for (const double slide : {0.0, 0.1, 1.0}) {
    const std::vector<Pair> pairs = randomPairs(random, 40);
    const IcpSums sums = sumsOf(pairs, slide);
    for (int i = 0; i < 6; ++i) {
      constexpr double kSmall = 1e-5;
      const double slope =
          (cost(pairs, along(i, kSmall), slide) - cost(pairs, along(i, -kSmall), slide)) /
          (2.0 * kSmall);
      // Half the slope, downhill: the right side of H x = g.
      EXPECT_NEAR(sums.gradient[i], -0.5 * slope, 1e-7) << "parameter " << i << ", slide " << slide;
    }
  }
}

TEST(IcpCoreTest, HessianIsGaussNewtons) {
  Random random(2);
  for (const double slide : {0.0, 0.25}) {
    std::vector<Pair> pairs = randomPairs(random, 40);
    // Without residuals Gauss-Newton's matrix is half of the cost's second derivative.
    for (Pair& pair : pairs) pair.model = pair.scene;
    const IcpSums sums = sumsOf(pairs, slide);
    constexpr double kSmall = 1e-3;
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) {
        double second = 0.0;
        for (const auto& [a, b] : {std::pair{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
          Step step = along(i, a * kSmall);
          step[static_cast<std::size_t>(j)] += b * kSmall;
          second += a * b * cost(pairs, step, slide);
        }
        second /= 4.0 * kSmall * kSmall;
        EXPECT_NEAR(sums.hessian[k++], 0.5 * second, 2e-4) << i << ", " << j << ", slide " << slide;
      }
    }
  }
}

TEST(IcpCoreTest, WeightAndSquaresAreThoseOfThePlanes) {
  Random random(3);
  const std::vector<Pair> pairs = randomPairs(random, 25);
  double weight = 0.0;
  for (const Pair& pair : pairs) weight += pair.weight;
  for (const double slide : {0.0, 0.5}) {
    const IcpSums sums = sumsOf(pairs, slide);
    EXPECT_NEAR(sums.weight, weight, 1e-12);
    EXPECT_NEAR(sums.squared, cost(pairs, {}, 0.0), 1e-12);
  }
}

/// Gaussian elimination with full row pivoting.
Step eliminate(std::array<std::array<double, 7>, 6> rows) {
  for (std::size_t column = 0; column < 6; ++column) {
    std::size_t pivot = column;
    for (std::size_t r = column; r < 6; ++r) {
      if (std::abs(rows[r][column]) > std::abs(rows[pivot][column])) pivot = r;
    }
    std::swap(rows[column], rows[pivot]);
    for (std::size_t r = 0; r < 6; ++r) {
      if (r == column) continue;
      const double factor = rows[r][column] / rows[column][column];
      for (std::size_t c = column; c < 7; ++c) rows[r][c] -= factor * rows[column][c];
    }
  }
  Step x{};
  for (std::size_t i = 0; i < 6; ++i) x[i] = rows[i][6] / rows[i][i];
  return x;
}

TEST(IcpCoreTest, SolveStepSolvesTheDampedEquations) {
  Random random(4);
  for (const double damping : {0.0, 1e-3, 2.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      const IcpSums sums = sumsOf(randomPairs(random, 12), 0.1);
      std::array<std::array<double, 7>, 6> rows{};
      int k = 0;
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = i; j < 6; ++j) rows[i][j] = rows[j][i] = sums.hessian[k++];
        rows[i][i] += damping;
        rows[i][6] = sums.gradient[i];
      }
      double x[6];
      ASSERT_TRUE(solveStep(sums, damping, x));
      const Step expected = eliminate(rows);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(x[i], expected[i], 1e-9) << i;
    }
  }
}

TEST(IcpCoreTest, AStepThatNothingHoldsIsRefused) {
  double x[6];
  EXPECT_FALSE(solveStep(IcpSums{}, 0.0, x)) << "no pairs at all";
  IcpSums negative{};
  for (const int diagonal : {0, 6, 11, 15, 18, 20}) negative.hessian[diagonal] = 1.0;
  EXPECT_TRUE(solveStep(negative, 0.0, x));
  negative.hessian[11] = -0.5;
  EXPECT_FALSE(solveStep(negative, 0.1, x));
  EXPECT_TRUE(solveStep(negative, 0.6, x)) << "damping makes it definite";
  negative.hessian[11] = std::nan("");
  EXPECT_FALSE(solveStep(negative, 0.6, x));
}

}  // namespace
}  // namespace rangepose
