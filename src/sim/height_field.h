// Height fields on a grid of square columns: the space that a part takes up, and the top of a heap.
#pragma once

#include "core/glm.h"
#include "core/image.h"
#include "geometry/mesh.h"

namespace rangepose {

/// The columns that hold a turned part, from its underside to its top; all between counts as
/// filled. Column (i, j) covers x from (x0 + i) * cell to (x0 + i + 1) * cell, y likewise.
struct PartColumns {
  int x0 = 0;           ///< [cells]
  int y0 = 0;           ///< [cells]
  Image<float> bottom;  ///< [mm], relative to the part's centre; +infinity in an empty column
  Image<float> top;     ///< [mm], relative to the part's centre; -infinity in an empty column
};

/// The columns of a mesh turned by `rotation` about `center_mm` (a point of the mesh's own frame),
/// which lies over (x, y) = `at_mm`. One column wider on all sides than sampled, so that the part
/// between two samples is inside too.
PartColumns columnsOf(const Mesh& mesh,
                      const glm::dvec3& center_mm,
                      const glm::dmat3& rotation,
                      const glm::dvec2& at_mm,
                      double cell_mm);

/// The top of all that lies on a table at height 0; it grows as parts are added.
class HeapTop {
 public:
  /// Covers |x|, |y| <= extent_mm; beyond it is the bare table.
  HeapTop(double extent_mm, double cell_mm);

  double cellMm() const { return cell_mm_; }
  /// Height of the part's centre when it is lowered from above until it first touches [mm].
  double restingHeight(const PartColumns& part) const;
  /// Adds a part whose centre lies at `height_mm`. Throws Error where it reaches beyond the extent.
  void add(const PartColumns& part, double height_mm);
  /// Height over column (i, j) [mm].
  float at(int i, int j) const;

 private:
  int half_;  ///< columns from the middle to a side
  double cell_mm_;
  Image<float> top_;
};

}  // namespace rangepose
