#include "geometry/twins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/normal_equations.h"
#include "geometry/surface_match.h"
#include "geometry/surface_sample.h"
#include "geometry/symmetry_search.h"

namespace rangepose {
namespace {

/// The rough search gives rotations that move the surface off itself by no more [share of the
/// diameter, a mean distance]: a pocket or a boss moves the mean by little.
constexpr double kRoughReach = 0.05;
constexpr double kNearly = 4.0;  // tolerances, before the last steps
/// Two twins closer than this are the same one.
constexpr double kApartRad = 10.0 * std::numbers::pi / 180.0;

struct Twin {
  Pose motion;
  double share = 0.0;  ///< of the surface that it leaves the same
};

class Finder {
 public:
  Finder(const Mesh& mesh, const TwinOptions& options)
      : surface_(mesh),
        options_(options),
        centre_mm_(areaMoments(mesh).centroid_mm),
        diameter_mm_(diameter(mesh)) {
    for (const glm::vec3& vertex : mesh.vertices)
      radius_mm_ = std::max(radius_mm_, glm::distance(glm::dvec3(vertex), centre_mm_));
  }

  std::vector<Twin> find() const {
    const std::vector<glm::dmat3> rough =
        findRoughSymmetries(surface_, centre_mm_, radius_mm_, kRoughReach * diameter_mm_);
    std::vector<Twin> twins(rough.size());
    parallelForEach(rough.size(), 1, [&](std::size_t i) {
      const Pose start{rough[i], centre_mm_ - rough[i] * centre_mm_};
      const Pose nearly = refined(start, {8, 150, 0.03, 0.01});
      // Most are far from being twins.
      if (shareOf(nearly, kNearly * options_.tolerance) < options_.least_share) return;
      twins[i].motion = refined(nearly, {16, 600, 0.01, 0.001});
      twins[i].share = shareOf(twins[i].motion, options_.tolerance);
    });
    return twins;
  }

 private:
  struct Steps {
    int count;
    std::size_t points;  ///< of the surface
    double first;  ///< distance from which on a point weighs little, in the first step [diameters]
    double last;   ///< and in the last one
  };

  /// What is far off is another feature and must not pull: each point weighs the less the farther
  /// it is from the surface (Geman-McClure), and ever more so.
  Pose refined(Pose motion, const Steps& steps) const {
    constexpr double kDamping = 1e-6;
    const std::vector<glm::dvec3>& sample = surface_.sample();
    for (int step = 0; step < steps.count; ++step) {
      const double done = static_cast<double>(step) / (steps.count - 1);
      const double scale_mm = diameter_mm_ * steps.first * std::pow(steps.last / steps.first, done);
      NormalEquations<6> sums;
      for (std::size_t i = 0; i < std::min(steps.points, sample.size()); ++i) {
        const glm::dvec3 point = motion * sample[i];
        const glm::dvec3 off = point - surface_.tree().nearest(point).point_mm;
        const double distance = glm::length(off);
        if (distance < 1e-9) continue;
        const double relative = distance / scale_mm;
        const double weight =
            1.0 / (1.0 + relative * relative);  // of the squared distance: squared
        const glm::dvec3 direction = weight / distance * off;
        const glm::dvec3 by_turn = glm::cross(point - centre_mm_, direction) / radius_mm_;
        sums.add({by_turn.x, by_turn.y, by_turn.z, direction.x, direction.y, direction.z},
                 weight * distance / radius_mm_);
      }
      const auto x = sums.solve(kDamping);
      const glm::dmat3 turn = rotationFromVector({x[0], x[1], x[2]});
      motion.rotation = orthonormalized(turn * motion.rotation);
      motion.translation_mm = centre_mm_ + turn * (motion.translation_mm - centre_mm_) +
                              radius_mm_ * glm::dvec3(x[3], x[4], x[5]);
    }
    return motion;
  }

  double shareOf(const Pose& motion, double reach) const {
    const std::vector<glm::dvec3>& sample = surface_.sample();
    const double reach_mm = reach * diameter_mm_;
    const auto on_surface = std::count_if(sample.begin(), sample.end(), [&](const auto& point) {
      return surface_.tree().touches(motion * point, reach_mm);
    });
    return static_cast<double>(on_surface) / static_cast<double>(sample.size());
  }

  SurfaceMatch surface_;
  TwinOptions options_;
  glm::dvec3 centre_mm_;
  double diameter_mm_;
  double radius_mm_ = 0.0;  ///< about the centre
};

}  // namespace

void TwinOptions::check() const {
  RP_CHECK(least_share > 0.0 && least_share <= 1.0, "least_share must be in (0, 1]");
  RP_CHECK(tolerance > 0.0 && tolerance <= 0.2, "tolerance must be in (0, 0.2]");
}

std::vector<Pose> findTwins(const Mesh& mesh,
                            const Symmetries& symmetries,
                            const TwinOptions& options) {
  options.check();
  checkMesh(mesh);
  std::vector<Twin> found = Finder(cleaned(mesh), options).find();
  std::stable_sort(
      found.begin(), found.end(), [](const Twin& a, const Twin& b) { return a.share > b.share; });
  std::vector<Pose> twins;
  const auto same = [&](const glm::dmat3& a, const glm::dmat3& b) {
    return rotationAngleModulo(symmetries, a, b) < kApartRad;
  };
  for (const Twin& twin : found) {
    if (twins.size() == options.most || twin.share < options.least_share) break;
    const glm::dmat3& rotation = twin.motion.rotation;
    const bool known = std::any_of(twins.begin(), twins.end(), [&](const Pose& other) {
      return same(rotation, other.rotation);
    });
    if (!known && !same(rotation, glm::dmat3(1.0))) twins.push_back(twin.motion);
  }
  return twins;
}

}  // namespace rangepose
