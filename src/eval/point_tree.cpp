#include "eval/point_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/error.h"

namespace rangepose {

PointTree::PointTree(std::vector<glm::dvec3> points) : points_(std::move(points)) {
  RP_CHECK(!points_.empty(), "a tree of points needs at least one point");
  order_.resize(points_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  split(0, order_.size(), 0);
}

std::size_t PointTree::nearest(const glm::dvec3& query) const {
  Best best{std::numeric_limits<double>::infinity(), order_.front()};
  search(query, 0, order_.size(), 0, best);
  return best.index;
}

// The ranges are halved, so the depth of the recursion is the logarithm of their number.
// NOLINTNEXTLINE(misc-no-recursion)
void PointTree::split(std::size_t begin, std::size_t end, int axis) {
  if (end - begin < 2) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [this, axis](std::size_t a, std::size_t b) {
    return points_[a][axis] < points_[b][axis];
  });
  const int next = (axis + 1) % 3;
  split(begin, middle, next);
  split(middle + 1, end, next);
}

// NOLINTNEXTLINE(misc-no-recursion)
void PointTree::search(
    const glm::dvec3& query, std::size_t begin, std::size_t end, int axis, Best& best) const {
  if (begin >= end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const glm::dvec3 offset = query - points_[order_[middle]];
  const double squared = glm::dot(offset, offset);
  if (squared < best.squared) best = {squared, order_[middle]};
  const int next = (axis + 1) % 3;
  const bool below = offset[axis] < 0.0;
  const std::pair<std::size_t, std::size_t> low{begin, middle};
  const std::pair<std::size_t, std::size_t> high{middle + 1, end};
  const auto [near_begin, near_end] = below ? low : high;
  search(query, near_begin, near_end, next, best);
  if (offset[axis] * offset[axis] >= best.squared) return;
  const auto [far_begin, far_end] = below ? high : low;
  search(query, far_begin, far_end, next, best);
}

}  // namespace rangepose
