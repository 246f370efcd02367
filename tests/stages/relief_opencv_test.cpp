// The smooth surface that a part is compared with, against OpenCV's least squares.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "stages/relief_core.h"

namespace rangepose {
namespace {

TEST(ReliefOpenCvTest, TheBestQuadricIsThatOfLeastSquares) {
  constexpr int kSide = 21;
  const auto depth = [](double x, double y) { return 3.0 + std::exp(x) * std::cos(2.0 * y); };
  ReliefSums sums;
  cv::Mat terms(kSide * kSide, ReliefSums::kTerms, CV_64F);
  cv::Mat depths(kSide * kSide, 1, CV_64F);
  for (int at = 0; at < kSide * kSide; ++at) {
    const double x = 2.0 * (at % kSide) / (kSide - 1) - 1.0;
    const double y = 2.0 * (at / kSide) / (kSide - 1) - 1.0;
    const double row[ReliefSums::kTerms] = {1.0, x, y, x * x, x * y, y * y};
    for (int k = 0; k < ReliefSums::kTerms; ++k) terms.at<double>(at, k) = row[k];
    depths.at<double>(at) = depth(x, y);
    sums.add(x, y, depth(x, y), 0.0, 1.0);
  }
  cv::Mat solution;
  cv::solve(terms, depths, solution, cv::DECOMP_SVD);
  const double expected = cv::norm(terms * solution - depths, cv::NORM_L2SQR);
  EXPECT_NEAR(quadricResidual(sums), expected, 1e-9 * expected);
}

}  // namespace
}  // namespace rangepose
