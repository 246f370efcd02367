#include "fit/evidence_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>

#include "core/error.h"

namespace rangepose::fit {
namespace {

constexpr int kTerms = static_cast<int>(kEvidenceTerms);
constexpr double kPull = 1.0;  // of each term [examples]

/// Of each row, so that all sensors count the same and the mean is 1.
std::vector<double> weightsOf(const std::vector<EvidenceRow>& rows) {
  std::map<std::string, int> counts;
  for (const EvidenceRow& row : rows) ++counts[row.sensor];
  std::vector<double> weights;
  const double even = static_cast<double>(rows.size()) / static_cast<double>(counts.size());
  for (const EvidenceRow& row : rows) weights.push_back(even / counts[row.sensor]);
  return weights;
}

/// Standard deviations of the terms; 1 for those that never change.
EvidenceTerms spreadOf(const std::vector<EvidenceRow>& rows) {
  EvidenceTerms spread;
  const double count = static_cast<double>(rows.size());
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    double sum = 0.0;
    double squares = 0.0;
    for (const EvidenceRow& row : rows) {
      sum += row.terms[i];
      squares += row.terms[i] * row.terms[i];
    }
    const double variance = squares / count - (sum / count) * (sum / count);
    spread[i] = variance > 1e-12 ? std::sqrt(variance) : 1.0;
  }
  return spread;
}

}  // namespace

EvidenceTerms fitEvidence(const std::vector<EvidenceRow>& rows) {
  constexpr int kSteps = 60;
  constexpr double kLongestStep = 3.0;
  const auto right =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.right; });
  if (right == 0 || right == static_cast<std::ptrdiff_t>(rows.size())) {
    throw Error("fit: the table needs right and wrong poses");
  }
  const EvidenceTerms spread = spreadOf(rows);
  const std::vector<double> weights = weightsOf(rows);
  cv::Mat x = cv::Mat::zeros(kTerms, 1, CV_64F);  // weights in units of the spread
  for (int step = 0; step < kSteps; ++step) {
    cv::Mat hessian = cv::Mat::zeros(kTerms, kTerms, CV_64F);
    cv::Mat gradient = cv::Mat::zeros(kTerms, 1, CV_64F);
    for (int i = 1; i < kTerms; ++i) {
      hessian.at<double>(i, i) = kPull;
      gradient.at<double>(i) = kPull * x.at<double>(i);
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double odds = 0.0;
      EvidenceTerms terms;
      for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
        terms[i] = rows[r].terms[i] / spread[i];
        odds += terms[i] * x.at<double>(static_cast<int>(i));
      }
      const double p = probabilityOf(odds);
      const double off = weights[r] * (p - (rows[r].right ? 1.0 : 0.0));
      const double curvature = weights[r] * std::max(p * (1.0 - p), 1e-6);
      for (int i = 0; i < kTerms; ++i) {
        const double term = terms[static_cast<std::size_t>(i)];
        gradient.at<double>(i) += off * term;
        for (int j = 0; j < kTerms; ++j)
          hessian.at<double>(i, j) += curvature * term * terms[static_cast<std::size_t>(j)];
      }
    }
    cv::Mat move;
    cv::solve(hessian, gradient, move, cv::DECOMP_CHOLESKY);
    const double longest = cv::norm(move, cv::NORM_INF);
    x -= move * std::min(1.0, kLongestStep / std::max(longest, 1e-12));
    if (longest < 1e-9) break;
  }
  EvidenceTerms result;
  for (std::size_t i = 0; i < kEvidenceTerms; ++i)
    result[i] = x.at<double>(static_cast<int>(i)) / spread[i];
  return result;
}

std::vector<EvidenceRow> examplesOf(const std::vector<EvidenceRow>& rows) {
  std::vector<EvidenceRow> examples;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(examples), [](const EvidenceRow& row) {
    return row.chosen || row.right;
  });
  return examples;
}

}  // namespace rangepose::fit
