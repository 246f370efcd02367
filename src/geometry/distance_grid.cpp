#include "geometry/distance_grid.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace rangepose {

DistanceGrid::DistanceGrid(const TriangleTree& tree,
                           const glm::dvec3& centre_mm,
                           double radius_mm,
                           int cells)
    : low_(centre_mm - glm::dvec3(radius_mm)),
      step_mm_(2.0 * radius_mm / cells),
      nodes_(cells + 1) {
  RP_CHECK(cells >= 1 && radius_mm > 0.0, "distance grid: needs a size");
  const std::size_t side = static_cast<std::size_t>(nodes_);
  values_.resize(side * side * side);
  parallelFor(nodes_, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      std::size_t index = static_cast<std::size_t>(k) * side * side;
      for (int j = 0; j < nodes_; ++j) {
        NearestPoint nearest;
        for (int i = 0; i < nodes_; ++i) {
          const glm::dvec3 point = low_ + step_mm_ * glm::dvec3(i, j, k);
          nearest = tree.nearest(point, nearest);
          values_[index++] = static_cast<float>(std::sqrt(nearest.squared_mm2));
        }
      }
    }
  });
}

DistanceGrid::Cell DistanceGrid::cellOf(const glm::dvec3& point_mm) const {
  const glm::dvec3 at =
      glm::clamp((point_mm - low_) / step_mm_, glm::dvec3(0.0), glm::dvec3(nodes_ - 1.001));
  const glm::dvec3 whole = glm::floor(at);
  const std::size_t side = static_cast<std::size_t>(nodes_);
  const std::size_t corner =
      (static_cast<std::size_t>(whole.z) * side + static_cast<std::size_t>(whole.y)) * side +
      static_cast<std::size_t>(whole.x);
  return {corner, at - whole};
}

double DistanceGrid::distance(const glm::dvec3& point_mm) const { return at(point_mm).distance_mm; }

DistanceGrid::Sample DistanceGrid::at(const glm::dvec3& point_mm) const {
  const Cell cell = cellOf(point_mm);
  const std::size_t side = static_cast<std::size_t>(nodes_);
  const float* value = values_.data() + cell.corner;
  const glm::dvec3& f = cell.fraction;
  // Two values along x on each of the four edges of the cell, then along y and z.
  const auto edge = [&](std::size_t offset) {
    return glm::dvec2(value[offset], value[offset + 1]);
  };
  const glm::dvec2 near_low = edge(0);
  const glm::dvec2 near_high = edge(side);
  const glm::dvec2 far_low = edge(side * side);
  const glm::dvec2 far_high = edge(side * side + side);
  const glm::dvec2 near = near_low + f.y * (near_high - near_low);
  const glm::dvec2 far = far_low + f.y * (far_high - far_low);
  const glm::dvec2 along_x = near + f.z * (far - near);
  const glm::dvec2 by_y =
      (near_high - near_low) + f.z * ((far_high - far_low) - (near_high - near_low));
  const glm::dvec2 by_z = far - near;
  Sample sample;
  sample.distance_mm = along_x.x + f.x * (along_x.y - along_x.x);
  sample.gradient = glm::dvec3(along_x.y - along_x.x,
                               by_y.x + f.x * (by_y.y - by_y.x),
                               by_z.x + f.x * (by_z.y - by_z.x)) /
                    step_mm_;
  return sample;
}

}  // namespace rangepose
