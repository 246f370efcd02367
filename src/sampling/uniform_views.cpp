#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/orientation_grid.h"
#include "sampling/view_sampling.h"
#include "sampling/view_symmetry.h"

namespace rangepose {
namespace {

/// The axis of a solid of revolution points everywhere, or into one half of all directions when
/// its ends are alike; what it is turned by about itself does not show.
std::vector<glm::dmat3> viewsOfRevolution(const glm::dvec3& axis, bool ends_alike, int count) {
  std::vector<glm::dmat3> views;
  for (int i = 0; i < count; ++i) {
    const double share = (i + 0.5) / count;
    const double z = ends_alike ? share : 2.0 * share - 1.0;
    const double around = 2.0 * std::numbers::pi * i / std::numbers::phi;
    const double r = std::sqrt(1.0 - z * z);
    views.push_back(shortestTurn(axis, {r * std::cos(around), r * std::sin(around), z}));
  }
  return views;
}

}  // namespace

std::vector<glm::dmat3> uniformViews(const Symmetries& symmetries, int count) {
  RP_CHECK(count >= 1, "at least one view is needed");
  const ViewSymmetry symmetry(symmetries);
  if (symmetry.sphere()) return {glm::dmat3(1.0)};
  if (symmetry.revolution()) {
    return viewsOfRevolution(symmetry.axis(), symmetry.endsAlike(), count);
  }
  if (symmetry.elements().size() == 1) return uniformRotations(count);
  AdaptiveOptions options;
  options.views = count;
  options.even_share = 1.0;
  return adaptiveViews(symmetries, {glm::dmat3(1.0)}, options);
}

Coverage coverageOf(const Symmetries& symmetries,
                    const std::vector<glm::dmat3>& views,
                    const std::vector<glm::dmat3>& orientations) {
  RP_CHECK(!views.empty() && !orientations.empty(), "coverage: no views or no orientations");
  std::vector<double> angles(orientations.size());
  parallelFor(static_cast<int>(orientations.size()), 16, [&](int begin, int end) {
    for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      double nearest = std::numbers::pi;
      for (const glm::dmat3& view : views) {
        nearest = std::min(nearest, rotationAngleModulo(symmetries, view, orientations[i]));
      }
      angles[i] = nearest;
    }
  });
  std::sort(angles.begin(), angles.end());
  Coverage coverage;
  for (const double angle : angles) coverage.mean += angle / static_cast<double>(angles.size());
  coverage.percentile_95 = angles[(angles.size() * 95 - 1) / 100];
  coverage.largest = angles.back();
  return coverage;
}

}  // namespace rangepose
