#include "geometry/stability.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/triangle_corners.h"

namespace rangepose {
namespace {

constexpr std::size_t kSize = 6;
using Row = std::array<double, kSize>;
using Matrix = std::array<Row, kSize>;

Matrix unpacked(const StabilityCovariance& covariance) {
  Matrix matrix{};
  int k = 0;
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = i; j < kSize; ++j) matrix[i][j] = matrix[j][i] = covariance.upper[k++];
  }
  return matrix;
}

/// Of rows whose two vectors are turned.
Matrix turned(const Matrix& matrix, const glm::dmat3& turn) {
  const auto element = [&](std::size_t i, std::size_t j) {
    return i / 3 == j / 3 ? turn[static_cast<int>(j % 3)][static_cast<int>(i % 3)] : 0.0;
  };
  Matrix half{};
  Matrix result{};
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j < kSize; ++j) {
      for (std::size_t k = 0; k < kSize; ++k) half[i][j] += element(i, k) * matrix[k][j];
    }
  }
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j < kSize; ++j) {
      for (std::size_t k = 0; k < kSize; ++k) result[i][j] += half[i][k] * element(j, k);
    }
  }
  return result;
}

/// Of part - share * whole, by Cholesky factorisation.
bool isPositiveDefinite(const Matrix& part, const Matrix& whole, double share) {
  Matrix lower{};
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = part[i][j] - share * whole[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      if (i == j && !(sum > 0.0)) return false;
      lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
    }
  }
  return true;
}

}  // namespace

StabilityCovariance stabilityCovariance(const Mesh& mesh, const Sphere& sphere) {
  StabilityCovariance covariance;
  double total = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners t(mesh, triangle);
    const double area = t.area();
    if (!(area > 0.0)) continue;
    total += area;
    const glm::dvec3 normal = t.cross() / (2.0 * area);
    // A polynomial of second degree: exact from the middles of the sides.
    for (const glm::dvec3& middle : {0.5 * (t.a + t.b), 0.5 * (t.b + t.c), 0.5 * (t.c + t.a)}) {
      covariance.add((middle - sphere.center_mm) / sphere.radius_mm, normal, area / 3.0);
    }
  }
  covariance.scale(1.0 / total);
  return covariance;
}

double stability(const StabilityCovariance& part,
                 const StabilityCovariance& whole,
                 const glm::dmat3& part_from_whole) {
  // Of a mean of unit normals; makes directions that nothing holds in either count as held.
  constexpr double kHeldAnyway = 1e-3;
  constexpr int kSteps = 14;
  Matrix own = unpacked(part);
  Matrix all = turned(unpacked(whole), part_from_whole);
  for (std::size_t i = 0; i < kSize; ++i) {
    own[i][i] += kHeldAnyway;
    all[i][i] += kHeldAnyway;
  }
  // The largest share of the whole that the part has in all directions.
  double low = 0.0;
  double high = 1.0;
  for (int step = 0; step < kSteps; ++step) {
    const double middle = 0.5 * (low + high);
    (isPositiveDefinite(own, all, middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace rangepose
