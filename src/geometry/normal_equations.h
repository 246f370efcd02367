// Small least-squares problems.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace rangepose {

/// Sums of rows of a linear least-squares problem in N unknowns.
template <std::size_t N>
class NormalEquations {
 public:
  using Row = std::array<double, N>;

  void add(const Row& row, double residual) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += row[i] * row[j];
      right_[i] -= residual * row[i];
    }
    rows_ += 1.0;
  }

  /// The step that minimises the squared sum of residual + row * step + rows * damping * |step|^2.
  /// Zero when there is nothing to solve.
  Row solve(double damping) const {
    std::array<Row, N> lower = matrix_;
    Row x = right_;
    for (std::size_t i = 0; i < N; ++i) {
      lower[i][i] += damping * rows_;
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = lower[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
        if (i == j && !(sum > 0.0)) return {};
        lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
      }
    }
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= lower[i][k] * x[k];
      x[i] /= lower[i][i];
    }
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t k = i + 1; k < N; ++k) x[i] -= lower[k][i] * x[k];
      x[i] /= lower[i][i];
    }
    return x;
  }

 private:
  std::array<Row, N> matrix_{};  ///< lower triangle
  Row right_{};
  double rows_ = 0.0;
};

}  // namespace rangepose
