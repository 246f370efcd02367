// Distance to a mesh, sampled on a grid: coarse and fast.
#pragma once

#include <vector>

#include "core/glm.h"
#include "geometry/mesh.h"
#include "geometry/triangle_tree.h"

namespace rangepose {

class DistanceGrid {
 public:
  /// `cells` along the longest side of a cube about `centre_mm` that holds a sphere of `radius_mm`.
  DistanceGrid(const TriangleTree& tree, const glm::dvec3& centre_mm, double radius_mm, int cells);

  struct Sample {
    double distance_mm = 0.0;
    glm::dvec3 gradient{0.0};
  };
  /// Interpolated; points outside of the cube count as on its border.
  Sample at(const glm::dvec3& point_mm) const;
  double distance(const glm::dvec3& point_mm) const;

 private:
  struct Cell {
    std::size_t corner;   ///< index of the lowest corner's value
    glm::dvec3 fraction;  ///< 0..1 within the cell
  };
  Cell cellOf(const glm::dvec3& point_mm) const;

  glm::dvec3 low_;
  double step_mm_;
  int nodes_;  ///< along a side
  std::vector<float> values_;
};

}  // namespace rangepose
