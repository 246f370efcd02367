// Rotations that leave most of a part the same, but not all of it: a lever turned upside down may
// differ from itself by a pocket alone.
#pragma once

#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"
#include "geometry/symmetry.h"

namespace rangepose {

struct TwinOptions {
  double least_share = 0.6;  ///< of the surface, that comes to lie on the surface
  double tolerance = 0.005;  ///< what lies that near to the surface lies on it, of the diameter
  std::size_t most = 8;      ///< of many the ones with the largest shares
  void check() const;        ///< throws Error naming the bad field
};

/// object_from_object of such rotations, the largest share first; none of `symmetries`, which are
/// those of the part, and of those that differ by one of them a single one. Where a pose fits what
/// is seen of a part, so does the pose times a twin, but for what tells them apart.
std::vector<Pose> findTwins(const Mesh& mesh,
                            const Symmetries& symmetries,
                            const TwinOptions& options = {});

}  // namespace rangepose
