#include "geometry/surface_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "geometry/triangle_corners.h"

namespace rangepose {
namespace {

double fraction(double value) { return value - std::floor(value); }

}  // namespace

std::vector<double> cumulativeAreas(const Mesh& mesh) {
  std::vector<double> until;
  until.reserve(mesh.triangles.size());
  double total = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles)
    until.push_back(total += TriangleCorners(mesh, triangle).area());
  return until;
}

glm::dmat3 diagonalise(glm::dmat3& matrix) {
  constexpr int kSweeps = 12;
  glm::dmat3 axes(1.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : std::array<std::array<int, 2>, 3>{{{0, 1}, {0, 2}, {1, 2}}}) {
      if (matrix[p][q] == 0.0) continue;
      const double half = 0.5 * std::atan2(2.0 * matrix[p][q], matrix[p][p] - matrix[q][q]);
      glm::dmat3 turn(1.0);
      turn[p][p] = turn[q][q] = std::cos(half);
      turn[p][q] = std::sin(half);
      turn[q][p] = -turn[p][q];
      matrix = glm::transpose(turn) * matrix * turn;
      axes = axes * turn;
    }
  }
  return axes;
}

std::vector<glm::dvec3> surfaceSample(const Mesh& mesh, int count) {
  RP_CHECK(count >= 1, "surface sample: at least one point is needed");
  checkMesh(mesh);
  const std::vector<double> until = cumulativeAreas(mesh);
  const double total = until.back();
  // Additive recurrences with the powers of the plastic number's cousin in three dimensions:
  // every first part of the sequence fills the unit cube evenly.
  constexpr double kRoot = 1.2207440846057594754;  // positive root of x^4 = x + 1
  std::vector<glm::dvec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double at = total * fraction(0.5 + i / kRoot);
    double u = fraction(0.5 + i / (kRoot * kRoot));
    double v = fraction(0.5 + i / (kRoot * kRoot * kRoot));
    const auto piece = std::upper_bound(until.begin(), until.end() - 1, at);
    const TriangleCorners t(
        mesh, mesh.triangles[static_cast<std::size_t>(std::distance(until.begin(), piece))]);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    points.push_back(t.a + u * (t.b - t.a) + v * (t.c - t.a));
  }
  return points;
}

AreaMoments areaMoments(const Mesh& mesh) {
  checkMesh(mesh);
  AreaMoments moments;
  double total = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners t(mesh, triangle);
    total += t.area();
    moments.centroid_mm += t.area() / 3.0 * (t.a + t.b + t.c);
  }
  moments.centroid_mm /= total;
  glm::dmat3 spread(0.0);
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners t(mesh, triangle);
    // Second moments of a triangle: exact from its corners and their sum.
    const std::array<glm::dvec3, 3> corners = {
        t.a - moments.centroid_mm, t.b - moments.centroid_mm, t.c - moments.centroid_mm};
    const glm::dvec3 sum = corners[0] + corners[1] + corners[2];
    const double weight = t.area() / (12.0 * total);
    spread += weight * glm::outerProduct(sum, sum);
    for (const glm::dvec3& corner : corners) spread += weight * glm::outerProduct(corner, corner);
  }
  const glm::dmat3 axes = diagonalise(spread);
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(
      order.begin(), order.end(), [&](int i, int j) { return spread[i][i] > spread[j][j]; });
  for (int i = 0; i < 3; ++i) {
    const int from = order[static_cast<std::size_t>(i)];
    moments.spread_mm2[i] = spread[from][from];
    moments.axes[i] = glm::normalize(axes[from]);
  }
  moments.axes[2] = glm::cross(moments.axes[0], moments.axes[1]);
  return moments;
}

double thickness(const Mesh& mesh) {
  const glm::dmat3 turned = glm::transpose(areaMoments(mesh).axes);
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  for (const glm::vec3& vertex : mesh.vertices) {
    low = glm::min(low, turned * glm::dvec3(vertex));
    high = glm::max(high, turned * glm::dvec3(vertex));
  }
  const glm::dvec3 extent = high - low;
  return std::min({extent.x, extent.y, extent.z});
}

}  // namespace rangepose
