// K-means on the sphere of viewing directions and on the circle of in-plane angles (paper
// Sect. 4.3).
#pragma once

#include <cstdint>
#include <vector>

#include "core/glm.h"

namespace rangepose {

/// A point of the unit sphere and how much it counts.
struct WeightedDirection {
  glm::dvec3 direction{0.0, 0.0, 1.0};
  double weight = 1.0;
};

/// Where a point belongs.
struct Assignment {
  int cluster = 0;
  int element = 0;       ///< the group element that brings it nearest to the centre
  double squared = 0.0;  ///< squared distance to it (Euclidean, chord)
};

struct DirectionClusters {
  std::vector<glm::dvec3> centres;      ///< unit vectors
  std::vector<Assignment> assignments;  ///< a point each
};

/// K-means with Euclidean distance on the unit sphere, modulo a finite group of rotations (the
/// identity first): a point belongs to the centre that any of its images comes nearest to, and
/// moves it by that image. So no centre is spent on a copy, and a cluster may reach across the
/// border of a fundamental domain.
///
/// Starts are drawn by k-means++ from `seed`. Gives fewer clusters than asked for when there are
/// fewer distinct points. The result does not depend on the number of threads.
DirectionClusters clusterDirections(const std::vector<WeightedDirection>& points,
                                    const std::vector<glm::dmat3>& group,
                                    int count,
                                    std::uint64_t seed);

/// The nearest centre of each point.
std::vector<Assignment> assignDirections(const std::vector<WeightedDirection>& points,
                                         const std::vector<glm::dvec3>& centres,
                                         const std::vector<glm::dmat3>& group);

struct WeightedAngle {
  double angle = 0.0;  ///< [rad]
  double weight = 1.0;
};

/// K-means with circular distance on angles of the given period; centres ascend within
/// [0, period). Starts are the quantiles, so that no draw is needed; without points they are the
/// answer, evenly spread.
std::vector<double> clusterAngles(const std::vector<WeightedAngle>& points,
                                  double period,
                                  int count);

}  // namespace rangepose
