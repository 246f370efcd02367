// Nearest neighbours among the points of a model: a k-d tree.
#pragma once

#include <cstddef>
#include <vector>

#include "core/glm.h"

namespace rangepose {

class PointTree {
 public:
  /// Throws Error when there is no point.
  explicit PointTree(std::vector<glm::dvec3> points);

  /// Index, in the order of the constructor, of a point with the smallest distance to `query`.
  std::size_t nearest(const glm::dvec3& query) const;

 private:
  struct Best {
    double squared;
    std::size_t index;
  };
  void split(std::size_t begin, std::size_t end, int axis);
  void search(
      const glm::dvec3& query, std::size_t begin, std::size_t end, int axis, Best& best) const;

  std::vector<glm::dvec3> points_;
  std::vector<std::size_t> order_;  ///< the median of each range splits it
};

}  // namespace rangepose
