// Whether a surface is smooth enough to be anything: read wrongly, a part is found on rods and
// plates, or not found at all.
#include <gtest/gtest.h>

#include <cmath>

#include "stages/relief_core.h"

namespace rangepose {
namespace {

constexpr int kSide = 21;

/// `depth(x, y)` over -1..1, and what it is off from the part.
template <typename Depth, typename Off>
ReliefSums sumsOf(const Depth& depth, const Off& off) {
  ReliefSums sums;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double x = 2.0 * i / (kSide - 1) - 1.0;
      const double y = 2.0 * j / (kSide - 1) - 1.0;
      sums.add(x, y, depth(x, y), off(x, y), 1.0);
    }
  }
  return sums;
}

double wave(double x, double y) { return std::sin(40.0 * x + 13.0) * std::cos(31.0 * y); }

TEST(ReliefTest, ARodIsAsGoodAsAnyOther) {
  const auto rod = [](double x, double y) { return 0.1 * y - std::sqrt(9.0 - x * x); };
  const auto noise = [](double x, double y) { return 0.02 * wave(x, y); };
  const ReliefSums sums =
      sumsOf([&](double x, double y) { return rod(x, y) + noise(x, y); }, noise);
  EXPECT_NEAR(reliefOf(sums, 1e-3), 0.0, 0.1) << "parts are found on rods of another kind";
}

TEST(ReliefTest, AStepIsNotSmooth) {
  const auto noise = [](double x, double y) { return 0.02 * wave(x, y); };
  const auto step = [&](double x, double y) { return (x > 0.0 ? 1.0 : 0.0) + noise(x, y); };
  // What the quadric leaves of a step of 1: 0.5 sqrt(1 - 0.75), 12 times the noise of 0.02 / 2.
  const double relief = reliefOf(sumsOf(step, noise), 1e-3);
  EXPECT_GT(relief, 2.0);
  EXPECT_LE(relief, 3.0);
}

TEST(ReliefTest, APoseThatIsWorseThanASmoothSurfaceSaysSo) {
  const auto plane = [](double x, double y) { return 5.0 + 0.3 * x - 0.2 * y; };
  const auto off = [](double x, double) { return 0.5 * x; };
  EXPECT_EQ(reliefOf(sumsOf(plane, off), 1e-3), -1.0);
}

TEST(ReliefTest, OfAWholeSurfaceItIsWhatWouldBeSeenOfIt) {
  const auto nothing = [](double, double) { return 0.0; };
  const auto step = [](double x, double) { return x > 0.0 ? 1.0 : 0.0; };
  const auto noise = [](double x, double y) { return 0.02 * wave(x, y); };
  const ReliefSums seen =
      sumsOf([&](double x, double y) { return step(x, y) + noise(x, y); }, noise);
  EXPECT_NEAR(
      reliefOfWhole(sumsOf(step, nothing), ownDeviation(seen), 1e-3), reliefOf(seen, 1e-3), 0.05)
      << "a part in full view would seem to hide something";
  const auto plane = [](double x, double y) { return 5.0 + 0.3 * x - 0.2 * y; };
  EXPECT_NEAR(reliefOfWhole(sumsOf(plane, nothing), 0.01, 1e-3), 0.0, 1e-6);
}

TEST(ReliefTest, AFewPixelsOrALineSayNothingWrong) {
  ReliefSums few;
  for (int i = 0; i < 10; ++i) few.add(0.1 * i, 0.0, i, 0.0, 1.0);
  EXPECT_EQ(reliefOf(few, 1e-3), 0.0);
  ReliefSums line;
  for (int i = 0; i < 100; ++i) line.add(0.02 * i - 1.0, 0.3, 1.0 + 0.01 * i, 0.0, 1.0);
  EXPECT_NEAR(quadricResidual(line), 0.0, 1e-9);
  EXPECT_TRUE(std::isfinite(reliefOf(line, 1e-3)));
}

}  // namespace
}  // namespace rangepose
