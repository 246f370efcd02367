// Distance from a point to a mesh: the triangles in a tree of boxes.
#pragma once

#include <limits>
#include <vector>

#include "core/glm.h"
#include "geometry/mesh.h"

namespace rangepose {

/// The point of a surface that is nearest to another point.
struct NearestPoint {
  glm::dvec3 point_mm{0.0};
  double squared_mm2 = std::numeric_limits<double>::infinity();  ///< squared distance to it
  int triangle = -1;                                             ///< index into the mesh
};

/// A copy of the triangles: the mesh may go. Const functions may be called by several threads.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);

  /// The nearest point of the surface; on a tie the triangle that the tree reaches first, always
  /// the same one.
  NearestPoint nearest(const glm::dvec3& point_mm) const { return nearest(point_mm, {}); }
  /// The same, faster when `guess` is a point of the surface not far from the nearest one, such as
  /// the answer for a neighbour.
  NearestPoint nearest(const glm::dvec3& point_mm, const NearestPoint& guess) const;
  /// Whether the surface comes within `reach_mm` of the point: much faster than nearest().
  bool touches(const glm::dvec3& point_mm, double reach_mm) const;

 private:
  struct Triangle {
    glm::dvec3 a, b, c;
    int index;
  };
  /// Boxes hold the children at `first` and `first + 1`, or `count` triangles from `first` on.
  struct Node {
    glm::dvec3 low, high;
    int first = 0;
    int count = 0;
  };
  void split(std::size_t node, int first, int count);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

/// The point of the triangle a, b, c that is nearest to `point`; it may have no area.
glm::dvec3 nearestOnTriangle(const glm::dvec3& point,
                             const glm::dvec3& a,
                             const glm::dvec3& b,
                             const glm::dvec3& c);

}  // namespace rangepose
