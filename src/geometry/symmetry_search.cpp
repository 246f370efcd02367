#include "geometry/symmetry_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "geometry/distance_grid.h"
#include "geometry/normal_equations.h"
#include "geometry/orientation_grid.h"

namespace rangepose {
namespace {

constexpr int kRotations = 20000;  // any rotation is within about 9 degrees of one of them
constexpr int kGridCells = 32;
constexpr std::size_t kScorePoints = 160;
constexpr std::size_t kRefinePoints = 300;
constexpr std::size_t kMostMinima = 240;
constexpr int kRefineSteps = 8;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kApartRad = 10.0 * kDegree;  // of two rough minima
constexpr double kSameRad = 3.0 * kDegree;    // of two refined minima
constexpr double kIdentityRad = 8.0 * kDegree;

struct Scored {
  glm::dmat3 rotation;
  double mean_square_mm2 = 0.0;
};

class RoughSearch {
 public:
  RoughSearch(const SurfaceMatch& surface, const glm::dvec3& centre_mm, double radius_mm)
      : grid_(surface.tree(), centre_mm, radius_mm, kGridCells),
        centre_(centre_mm),
        radius_(radius_mm) {
    for (std::size_t i = 0; i < kRefinePoints; ++i) {
      points_.push_back(surface.sample()[i] - centre_mm);
    }
  }

  double meanSquare(const glm::dmat3& rotation, std::size_t points) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points; ++i) {
      const double distance = grid_.distance(centre_ + rotation * points_[i]);
      sum += distance * distance;
    }
    return sum / static_cast<double>(points);
  }

  std::vector<Scored> scoreAll() const {
    const std::vector<glm::dmat3> rotations = uniformRotations(kRotations);
    std::vector<Scored> scored(rotations.size());
    parallelFor(kRotations, 500, [&](int begin, int end) {
      for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end);
           ++i) {
        scored[i] = {rotations[i], meanSquare(rotations[i], kScorePoints)};
      }
    });
    return scored;
  }

  Scored refined(const glm::dmat3& start) const {
    glm::dmat3 turn = start;
    for (int step = 0; step < kRefineSteps; ++step) {
      NormalEquations<3> sums;
      for (const glm::dvec3& point : points_) {
        const glm::dvec3 to = turn * point;
        const DistanceGrid::Sample sample = grid_.at(centre_ + to);
        const glm::dvec3 row = glm::cross(to, sample.gradient) / radius_;
        sums.add({row.x, row.y, row.z}, sample.distance_mm / radius_);
      }
      const auto x = sums.solve(1e-3);
      glm::dvec3 move(x[0], x[1], x[2]);
      const double length = glm::length(move);
      if (length > kApartRad) move *= kApartRad / length;
      turn = orthonormalized(rotationFromVector(move) * turn);
    }
    return {turn, meanSquare(turn, points_.size())};
  }

 private:
  DistanceGrid grid_;
  glm::dvec3 centre_;
  double radius_;
  std::vector<glm::dvec3> points_;  ///< relative to the centre
};

/// The best ones of which no two are closer than `apart_rad`, none near the identity.
std::vector<Scored> spread(std::vector<Scored> scored, double apart_rad, std::size_t most) {
  std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) {
    return a.mean_square_mm2 < b.mean_square_mm2;
  });
  std::vector<Scored> kept;
  for (const Scored& next : scored) {
    if (kept.size() == most) break;
    if (rotationAngleBetween(next.rotation, glm::dmat3(1.0)) < kIdentityRad) continue;
    const bool taken = std::any_of(kept.begin(), kept.end(), [&](const Scored& other) {
      return rotationAngleBetween(next.rotation, other.rotation) < apart_rad;
    });
    if (!taken) kept.push_back(next);
  }
  return kept;
}

}  // namespace

std::vector<glm::dmat3> findRoughSymmetries(const SurfaceMatch& surface,
                                            const glm::dvec3& centre_mm,
                                            double radius_mm,
                                            double reach_mm) {
  const RoughSearch search(surface, centre_mm, radius_mm);
  std::vector<Scored> minima = spread(search.scoreAll(), kApartRad, kMostMinima);
  for (Scored& minimum : minima) minimum = search.refined(minimum.rotation);
  // Interpolation rounds the surface off: a perfect match is left with some of a cell's width.
  const double limit = reach_mm + 0.4 * 2.0 * radius_mm / kGridCells;
  std::vector<glm::dmat3> rotations;
  for (const Scored& minimum : spread(minima, kSameRad, kMostMinima)) {
    if (minimum.mean_square_mm2 <= limit * limit) rotations.push_back(minimum.rotation);
  }
  return rotations;
}

}  // namespace rangepose
