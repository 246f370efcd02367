// Which orientations of a part become views of the database (paper Sect. 4.3).
#pragma once

#include <cstdint>
#include <vector>

#include "core/glm.h"
#include "geometry/symmetry.h"

namespace rangepose {

struct AdaptiveOptions {
  int views = 1024;  ///< N_ref
  /// Weight of an even spread over all orientations, against that of the observed ones [0..1]: what
  /// never came to lie in the simulation may still lie in the bin, and cameras are tilted. K-means
  /// evens out weights, so that at one half the orientations in which most parts rest still get
  /// many times the views of others, and the gaps between those stay as with uniform views.
  double even_share = 0.5;
  /// Half angle of the cone about the vertical from which each orientation counts as seen [rad].
  /// Wider ones suit tilted cameras and wide lenses, but blunt what is gained below the camera.
  double cone_rad = 0.0;
  std::uint64_t seed = 1;  ///< of k-means++
  void check() const;      ///< throws Error naming the bad field
};

/// Views (view_from_object) spread evenly over all orientations that look different: for a
/// part without symmetries uniformRotations(count); for one with a finite group the clusters of
/// even data, which leave smaller gaps modulo the group. A sphere needs one view only.
std::vector<glm::dmat3> uniformViews(const Symmetries& symmetries, int count);

/// Views where the part is likely to lie. `resting` are orientations as in PoseStatistics.
///
/// Hierarchical k-means: viewing directions first, then in-plane angles inside each cluster of
/// directions, both modulo the symmetries. The bin may lie at any angle under the camera, so each
/// orientation counts at in-plane angles all around.
///
/// Differs from the paper: K2 is not the same for all clusters. Where views are many, the mean
/// squared angle to the nearest one falls most when each next view goes to the cluster that gains
/// most by it; K1 is the one of some shares of N for which that mean is smallest, measured on
/// orientations that were not used for clustering. For N = 1,024 and even data that gives K1 about
/// 64, as in the paper.
std::vector<glm::dmat3> adaptiveViews(const Symmetries& symmetries,
                                      const std::vector<glm::dmat3>& resting,
                                      const AdaptiveOptions& options);

/// Angles from orientations to the nearest view, modulo symmetries [rad].
struct Coverage {
  double mean = 0.0;
  double percentile_95 = 0.0;
  double largest = 0.0;
};
Coverage coverageOf(const Symmetries& symmetries,
                    const std::vector<glm::dmat3>& views,
                    const std::vector<glm::dmat3>& orientations);

}  // namespace rangepose
