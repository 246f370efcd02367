#include "sampling/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/random.h"

namespace rangepose {
namespace {

constexpr int kRounds = 30;
constexpr int kGrain = 512;

double squaredLength(const glm::dvec3& v) { return glm::dot(v, v); }

/// The images of the centres under the group: all points that a direction may be near to.
class Images {
 public:
  Images(const std::vector<glm::dvec3>& centres, const std::vector<glm::dmat3>& group)
      : group_size_(static_cast<int>(group.size())) {
    for (const glm::dvec3& centre : centres) {
      for (const glm::dmat3& element : group) images_.push_back(centre * element);
    }
  }

  Assignment nearest(const glm::dvec3& direction) const {
    double best = -2.0;
    int index = 0;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      const double cosine = glm::dot(images_[i], direction);
      if (cosine > best) {
        best = cosine;
        index = static_cast<int>(i);
      }
    }
    return {index / group_size_, index % group_size_, std::max(0.0, 2.0 - 2.0 * best)};
  }

 private:
  int group_size_;
  std::vector<glm::dvec3> images_;
};

std::vector<Assignment> assign(const std::vector<WeightedDirection>& points, const Images& images) {
  std::vector<Assignment> assignments(points.size());
  parallelFor(static_cast<int>(points.size()), kGrain, [&](int begin, int end) {
    for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      assignments[i] = images.nearest(points[i].direction);
    }
  });
  return assignments;
}

/// k-means++: each further centre is drawn with a chance that grows with the squared distance to
/// those there already.
std::vector<glm::dvec3> drawCentres(const std::vector<WeightedDirection>& points,
                                    const std::vector<glm::dmat3>& group,
                                    int count,
                                    std::uint64_t seed) {
  Random random(seed);
  std::vector<double> squared(points.size(), 1.0);
  std::vector<glm::dvec3> centres;
  while (static_cast<int>(centres.size()) < count) {
    double total = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) total += points[i].weight * squared[i];
    if (!(total > 1e-12)) break;
    double left = random.uniform() * total;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double share = points[i].weight * squared[i];
      if (share <= 0.0) continue;
      chosen = i;
      left -= share;
      if (left < 0.0) break;
    }
    centres.push_back(points[chosen].direction);
    const Images images({centres.back()}, group);
    const bool first = centres.size() == 1;
    parallelFor(static_cast<int>(points.size()), kGrain, [&](int begin, int end) {
      for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end);
           ++i) {
        const double distance = images.nearest(points[i].direction).squared;
        squared[i] = first ? distance : std::min(squared[i], distance);
      }
    });
    squared[chosen] = 0.0;
  }
  return centres;
}

/// A full turn less at the seam: an angle within [0, period).
double wrapped(double angle, double period) {
  const double rest = angle - std::floor(angle / period) * period;
  return rest < period ? rest : 0.0;
}

/// Angles that leave (i + 1/2) / count of the weight below them.
std::vector<double> quantiles(const std::vector<WeightedAngle>& points, double period, int count) {
  std::vector<WeightedAngle> sorted = points;
  double total = 0.0;
  for (WeightedAngle& point : sorted) {
    point.angle = wrapped(point.angle, period);
    total += point.weight;
  }
  std::sort(sorted.begin(), sorted.end(), [](const WeightedAngle& a, const WeightedAngle& b) {
    return a.angle < b.angle;
  });
  std::vector<double> result;
  double below = 0.0;
  std::size_t next = 0;
  for (int i = 0; i < count; ++i) {
    const double share = (i + 0.5) / count;
    while (next < sorted.size() && below + sorted[next].weight < share * total) {
      below += sorted[next++].weight;
    }
    result.push_back(next < sorted.size() ? sorted[next].angle : period * share);
  }
  return result;
}

}  // namespace

DirectionClusters clusterDirections(const std::vector<WeightedDirection>& points,
                                    const std::vector<glm::dmat3>& group,
                                    int count,
                                    std::uint64_t seed) {
  RP_CHECK(!points.empty() && !group.empty() && count >= 1, "clusters: nothing to cluster");
  DirectionClusters clusters{drawCentres(points, group, count, seed), {}};
  if (clusters.centres.empty()) clusters.centres.push_back(points[0].direction);
  for (int round = 0; round < kRounds; ++round) {
    clusters.assignments = assign(points, Images(clusters.centres, group));
    std::vector<glm::dvec3> sums(clusters.centres.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Assignment& own = clusters.assignments[i];
      sums[static_cast<std::size_t>(own.cluster)] +=
          points[i].weight * (group[static_cast<std::size_t>(own.element)] * points[i].direction);
    }
    double moved = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (!(glm::length(sums[i]) > 1e-12)) continue;
      const glm::dvec3 centre = glm::normalize(sums[i]);
      moved = std::max(moved, squaredLength(centre - clusters.centres[i]));
      clusters.centres[i] = centre;
    }
    if (moved < 1e-8) break;
  }
  clusters.assignments = assignDirections(points, clusters.centres, group);
  return clusters;
}

std::vector<Assignment> assignDirections(const std::vector<WeightedDirection>& points,
                                         const std::vector<glm::dvec3>& centres,
                                         const std::vector<glm::dmat3>& group) {
  RP_CHECK(!centres.empty() && !group.empty(), "clusters: no centre to assign to");
  return assign(points, Images(centres, group));
}

std::vector<double> clusterAngles(const std::vector<WeightedAngle>& points,
                                  double period,
                                  int count) {
  RP_CHECK(period > 0.0 && count >= 1, "clusters: nothing to cluster");
  std::vector<double> centres = quantiles(points, period, count);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> shift(centres.size(), 0.0);
    std::vector<double> weight(centres.size(), 0.0);
    for (const WeightedAngle& point : points) {
      const double angle = wrapped(point.angle, period);
      // The neighbours on the ring of ascending centres: the nearest centre is one of them.
      const std::size_t above = static_cast<std::size_t>(
          std::upper_bound(centres.begin(), centres.end(), angle) - centres.begin());
      const std::size_t high = above % centres.size();
      const std::size_t low = (above + centres.size() - 1) % centres.size();
      const double to_high = wrapped(centres[high] - angle, period);
      const double to_low = wrapped(angle - centres[low], period);
      const bool up = to_high < to_low;
      shift[up ? high : low] += point.weight * (up ? -to_high : to_low);
      weight[up ? high : low] += point.weight;
    }
    double moved = 0.0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      if (weight[i] <= 0.0) continue;
      const double step = shift[i] / weight[i];
      centres[i] = wrapped(centres[i] + step, period);
      moved = std::max(moved, std::abs(step));
    }
    std::sort(centres.begin(), centres.end());
    if (moved < 1e-6 * period) break;
  }
  return centres;
}

}  // namespace rangepose
