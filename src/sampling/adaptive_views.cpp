#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "core/error.h"
#include "core/pose.h"
#include "geometry/orientation_grid.h"
#include "sampling/clusters.h"
#include "sampling/view_sampling.h"
#include "sampling/view_symmetry.h"

namespace rangepose {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kTilts = 3;             // directions within the cone that each orientation counts at
constexpr int kEvenRotations = 3000;  // that stand for all orientations
constexpr double kWork = 1.5e9;       // distances that one clustering may take
constexpr int kRounds = 30;           // that it is reckoned with

struct Observation {
  glm::dmat3 rotation;  ///< folded
  double weight;
};

glm::dmat3 tilted(const glm::dmat3& rotation, std::size_t index, double cone_rad) {
  const double share = std::fmod((static_cast<double>(index) + 0.5) / std::numbers::sqrt2, 1.0);
  const double around = 2.0 * kPi * static_cast<double>(index) / std::numbers::phi;
  const double tilt = cone_rad * std::sqrt(share);
  return rotationFromVector({tilt * std::cos(around), tilt * std::sin(around), 0.0}) * rotation;
}

std::vector<Observation> observationsOf(const ViewSymmetry& symmetry,
                                        const std::vector<glm::dmat3>& resting,
                                        const AdaptiveOptions& options) {
  std::vector<Observation> observations;
  const int tilts = options.cone_rad > 0.0 ? kTilts : 1;
  const double count = static_cast<double>(resting.size() * static_cast<std::size_t>(tilts));
  for (const glm::dmat3& rotation : resting) {
    for (int i = 0; i < tilts && options.even_share < 1.0; ++i) {
      const glm::dmat3 seen = tilted(rotation, observations.size(), options.cone_rad);
      observations.push_back({symmetry.folded(seen), (1.0 - options.even_share) / count});
    }
  }
  if (options.even_share <= 0.0) return observations;
  for (const glm::dmat3& rotation : uniformRotations(kEvenRotations)) {
    observations.push_back({symmetry.folded(rotation), options.even_share / kEvenRotations});
  }
  return observations;
}

std::vector<WeightedDirection> directionsOf(const std::vector<Observation>& observations,
                                            std::size_t first,
                                            std::size_t stride) {
  std::vector<WeightedDirection> directions;
  for (std::size_t i = first; i < observations.size(); i += stride) {
    directions.push_back({viewDirection(observations[i].rotation), observations[i].weight});
  }
  return directions;
}

/// What a cluster of directions asks for.
struct Cell {
  double weight = 0.0;
  double spread = 0.0;  ///< weighted sum of squared distances to the centre [rad^2]
  double effect = 0.0;  ///< weighted sum of squared effects of an in-plane turn
  double reach = 0.0;   ///< of a disc with that spread [rad]
  int copies = 1;       ///< in-plane angles that look the same
  int angles = 1;       ///< K2

  double period() const { return 2.0 * kPi / copies; }
  /// Weighted mean squared angle to the nearest of k even in-plane angles, about an axis that moves
  /// the part by `effect`.
  double inPlane(int k) const { return effect * period() * period() / (12.0 * k * k); }
  double gain() const { return inPlane(angles) - inPlane(angles + 1); }
};

std::vector<Cell> cellsOf(const ViewSymmetry& symmetry,
                          const std::vector<glm::dvec3>& centres,
                          const std::vector<WeightedDirection>& points,
                          const std::vector<Assignment>& assignments) {
  std::vector<Cell> cells(centres.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Cell& cell = cells[static_cast<std::size_t>(assignments[i].cluster)];
    const double effect = symmetry.inPlaneEffect(points[i].direction);
    cell.weight += points[i].weight;
    cell.spread += points[i].weight * assignments[i].squared;
    cell.effect += points[i].weight * effect * effect;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Cell& cell = cells[i];
    if (cell.weight > 0.0) cell.reach = std::sqrt(2.0 * cell.spread / cell.weight);
    cell.copies = symmetry.inPlaneCopies(centres[i], 0.5 * cell.reach);
  }
  return cells;
}

/// Gives each next view to the cell that gains most. Returns the mean squared angle that is left.
double shareOut(std::vector<Cell>& cells, int views) {
  using Entry = std::pair<double, std::size_t>;
  const auto later = [](const Entry& a, const Entry& b) {
    return a.first < b.first || (a.first == b.first && a.second > b.second);
  };
  std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
  for (std::size_t i = 0; i < cells.size(); ++i) queue.emplace(cells[i].gain(), i);
  for (int left = views - static_cast<int>(cells.size()); left > 0; --left) {
    const std::size_t best = queue.top().second;
    queue.pop();
    ++cells[best].angles;
    queue.emplace(cells[best].gain(), best);
  }
  double total = 0.0;
  for (const Cell& cell : cells) total += cell.spread + cell.inPlane(cell.angles);
  return total;
}

class Sampler {
 public:
  Sampler(const Symmetries& symmetries,
          const std::vector<glm::dmat3>& resting,
          const AdaptiveOptions& options)
      : symmetry_(symmetries),
        options_(options),
        observations_(observationsOf(symmetry_, resting, options)) {}

  std::vector<glm::dmat3> views() const {
    const int directions = bestDirectionCount();
    const std::size_t stride = strideFor(directions, 1);
    const std::vector<WeightedDirection> points = directionsOf(observations_, 0, stride);
    const DirectionClusters clusters =
        clusterDirections(points, symmetry_.elements(), directions, options_.seed);
    std::vector<Cell> cells = cellsOf(symmetry_, clusters.centres, points, clusters.assignments);
    shareOut(cells, options_.views);
    std::vector<std::vector<WeightedAngle>> angles(cells.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Assignment& own = clusters.assignments[i];
      const std::size_t cell = static_cast<std::size_t>(own.cluster);
      const double angle =
          inPlaneAngle(observations_[i * stride].rotation, own, clusters.centres[cell]);
      for (int turn = 0; turn < kTurns; ++turn) {
        angles[cell].push_back({angle + cells[cell].period() * turn / kTurns, points[i].weight});
      }
    }
    std::vector<glm::dmat3> views;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const glm::dmat3 upright = shortestTurn(clusters.centres[i], {0.0, 0.0, 1.0});
      for (const double angle : clusterAngles(angles[i], cells[i].period(), cells[i].angles)) {
        views.push_back(rotationFromVector({0.0, 0.0, angle}) * upright);
      }
    }
    return views;
  }

 private:
  static constexpr int kTurns = 8;  // in-plane angles that each observation counts at

  /// Every how many observations are used, so that clustering stays quick for large groups.
  std::size_t strideFor(int directions, std::size_t least) const {
    const double each = static_cast<double>(directions) * kRounds *
                        static_cast<double>(symmetry_.elements().size());
    const double most = std::max(kWork / each, 8.0 * directions);
    const double stride = static_cast<double>(observations_.size()) / most;
    return std::max(least, static_cast<std::size_t>(std::ceil(stride)));
  }

  /// K1: the one that leaves the smallest mean squared angle on observations left out.
  int bestDirectionCount() const {
    int best_count = 1;
    double best = std::numeric_limits<double>::infinity();
    for (const int share : {3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
      const int count = std::max(1, options_.views / share);
      const std::size_t stride = strideFor(count, 8);
      const std::vector<WeightedDirection> used = directionsOf(observations_, 0, stride);
      const DirectionClusters clusters =
          clusterDirections(used, symmetry_.elements(), count, options_.seed);
      const std::vector<WeightedDirection> others = directionsOf(observations_, stride / 2, stride);
      std::vector<Cell> cells =
          cellsOf(symmetry_,
                  clusters.centres,
                  others,
                  assignDirections(others, clusters.centres, symmetry_.elements()));
      const double left = shareOut(cells, options_.views);
      if (left >= best) continue;
      best = left;
      best_count = count;
    }
    return best_count;
  }

  /// The angle by which the observation is turned in the plane against the view of the centre that
  /// `shortestTurn` makes, after the shortest turn between the directions.
  double inPlaneAngle(const glm::dmat3& rotation,
                      const Assignment& own,
                      const glm::dvec3& centre) const {
    const glm::dmat3& element = symmetry_.elements()[static_cast<std::size_t>(own.element)];
    const glm::dmat3 image = rotation * glm::transpose(element);
    const glm::dmat3 base =
        shortestTurn(centre, {0.0, 0.0, 1.0}) * shortestTurn(viewDirection(image), centre);
    const glm::dmat3 turn = image * glm::transpose(base);
    return std::atan2(turn[0][1], turn[0][0]);
  }

  ViewSymmetry symmetry_;
  AdaptiveOptions options_;
  std::vector<Observation> observations_;
};

}  // namespace

void AdaptiveOptions::check() const {
  RP_CHECK(views >= 1 && views <= 65536, "adaptive views: views must be in 1..65536");
  RP_CHECK(even_share >= 0.0 && even_share <= 1.0, "adaptive views: even_share must be in 0..1");
  RP_CHECK(cone_rad >= 0.0 && cone_rad < 1.2, "adaptive views: cone_rad must be in 0..1.2");
}

std::vector<glm::dmat3> adaptiveViews(const Symmetries& symmetries,
                                      const std::vector<glm::dmat3>& resting,
                                      const AdaptiveOptions& options) {
  options.check();
  RP_CHECK(!resting.empty(), "adaptive views: no resting orientation is given");
  if (ViewSymmetry(symmetries).sphere()) return {glm::dmat3(1.0)};
  return Sampler(symmetries, resting, options).views();
}

}  // namespace rangepose
