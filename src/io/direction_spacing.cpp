#include "io/direction_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace rangepose {
namespace {

constexpr std::size_t kSample = 2000;
constexpr std::size_t kNeighbours = 3;

struct Cell {
  std::int64_t x = 0;
  std::int64_t y = 0;
  auto operator<=>(const Cell&) const = default;
};

/// Points sorted by the cell of a square grid that they lie in.
class CellIndex {
 public:
  CellIndex(const std::vector<glm::dvec2>& points, double cell_size) : cell_size_(cell_size) {
    entries_.reserve(points.size());
    for (const glm::dvec2& point : points) entries_.emplace_back(cellOf(point), point);
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      if (a.first != b.first) return a.first < b.first;
      return a.second.x != b.second.x ? a.second.x < b.second.x : a.second.y < b.second.y;
    });
    // Positions that several points share count once.
    entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  }

  /// Distance to the third nearest other position, infinite where none of the 3 x 3 cells around
  /// the point can tell it.
  double thirdNearest(const glm::dvec2& point) const {
    std::array<double, kNeighbours> nearest{};
    nearest.fill(std::numeric_limits<double>::infinity());
    const Cell center = cellOf(point);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      const Cell first{center.x + dx, center.y - 1};
      const Cell last{center.x + dx, center.y + 1};
      auto entry = std::lower_bound(
          entries_.begin(), entries_.end(), first, [](const Entry& e, const Cell& cell) {
            return e.first < cell;
          });
      for (; entry != entries_.end() && entry->first <= last; ++entry) {
        const double distance = glm::distance(entry->second, point);
        if (distance == 0.0 || distance >= nearest.back()) continue;
        nearest.back() = distance;
        std::sort(nearest.begin(), nearest.end());
      }
    }
    return nearest.back() <= cell_size_ ? nearest.back() : std::numeric_limits<double>::infinity();
  }

 private:
  using Entry = std::pair<Cell, glm::dvec2>;

  Cell cellOf(const glm::dvec2& point) const {
    return {static_cast<std::int64_t>(std::floor(point.x / cell_size_)),
            static_cast<std::int64_t>(std::floor(point.y / cell_size_))};
  }

  double cell_size_;
  std::vector<Entry> entries_;
};

/// Extent of the middle nine tenths of the values: a few strays do not stretch it.
double robustExtent(std::vector<double> values) {
  const std::size_t margin = values.size() / 20;
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(margin);
  const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(margin);
  std::nth_element(values.begin(), low, values.end());
  const double first = *low;
  std::nth_element(values.begin(), high, values.end());
  return *high - first;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double typicalSpacing(const std::vector<glm::dvec2>& points) {
  if (points.size() <= kNeighbours) return 0.0;
  std::vector<double> xs;
  std::vector<double> ys;
  for (const glm::dvec2& point : points) {
    xs.push_back(point.x);
    ys.push_back(point.y);
  }
  const double extent = std::max(robustExtent(std::move(xs)), robustExtent(std::move(ys)));
  if (!(extent > 0.0)) return 0.0;

  // Clouds cover their extent unevenly: the cells are grown until those of most points hold the
  // neighbours, from a quarter of the spacing that an evenly filled square would have.
  double cell_size = 0.25 * extent / std::sqrt(static_cast<double>(points.size()));
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSample);
  while (cell_size <= 2.0 * extent) {
    const CellIndex index(points, cell_size);
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); i += step) {
      distances.push_back(index.thirdNearest(points[i]));
    }
    const double median = medianOf(distances);
    if (std::isfinite(median)) return median;
    cell_size *= 2.0;
  }
  return 0.0;
}

}  // namespace rangepose
