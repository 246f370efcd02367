#include "geometry/symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/error.h"
#include "geometry/orientation_grid.h"
#include "geometry/rotation_group.h"
#include "geometry/surface_match.h"
#include "geometry/surface_sample.h"
#include "geometry/symmetry_search.h"

namespace rangepose {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kLargestOrder = 120;    // more sides than that are a circle to any camera
constexpr double kRoughReach = 2.0;   // tolerances, before the axis is refined
constexpr double kSameAxis = 0.9962;  // cosine of 5 degrees
constexpr std::size_t kMostTrials = 60;

/// Turns about z that fall in with no regular tessellation.
std::vector<glm::dmat3> unevenTurns(int count) {
  std::vector<glm::dmat3> turns;
  for (int i = 1; i <= count; ++i) {
    const double share = i / std::numbers::phi;
    turns.push_back(turnAboutZ(2.0 * kPi * (share - std::floor(share))));
    turns.push_back(glm::transpose(turns.back()));
  }
  return turns;
}

std::vector<glm::dmat3> withHalfTurns(std::vector<glm::dmat3> turns) {
  const glm::dmat3 half_turn = dihedralGroup(1)[1];
  const std::size_t count = turns.size();
  for (std::size_t i = 0; i < count; ++i) turns.push_back(turns[i] * half_turn);
  return turns;
}

std::vector<glm::dmat3> withoutIdentity(std::vector<glm::dmat3> group) {
  group.erase(group.begin());
  return group;
}

/// An axis about which the surface is symmetric.
struct Axis {
  GroupFrame frame;  ///< z is the axis
  int order = 0;     ///< 0: any angle
};

struct Candidate {
  std::vector<glm::dmat3> group;
  GroupFrame frame;
};

class Finder {
 public:
  Finder(const Mesh& mesh, const SymmetryOptions& options)
      : surface_(mesh), moments_(areaMoments(mesh)), reach_mm_(options.tolerance * diameter(mesh)) {
    for (const glm::vec3& vertex : mesh.vertices) {
      radius_mm_ = std::max(radius_mm_, glm::distance(glm::dvec3(vertex), moments_.centroid_mm));
    }
  }

  Symmetries find() {
    for (int i = 2; i >= 0; --i) {
      tryAxis(moments_.axes[i]);
      if (round_) return revolution(*round_);
    }
    const std::vector<glm::dmat3> rotations =
        findRoughSymmetries(surface_, moments_.centroid_mm, radius_mm_, reach_mm_);
    std::size_t trials = 0;
    for (const glm::dmat3& rotation : rotations) {
      std::optional<glm::dvec3> direction = axisOf(rotation);
      if (!direction || known(*direction)) continue;
      direction = axisOf(surface_.refinedRotation(rotation, moments_.centroid_mm));
      if (!direction || known(*direction)) continue;
      tryAxis(*direction);
      if (round_) return revolution(*round_);
      if (++trials == kMostTrials) break;
    }
    return largestGroup();
  }

 private:
  static std::optional<glm::dvec3> axisOf(const glm::dmat3& rotation) {
    constexpr double kSmallest = 0.1;  // a small angle says little about the axis [rad]
    if (rotationAngleBetween(rotation, glm::dmat3(1.0)) < kSmallest) return std::nullopt;
    // R + R^T - (trace - 1) I = 2 (1 - cos) * u u^T: its longest column is parallel to u.
    const double trace = rotation[0][0] + rotation[1][1] + rotation[2][2];
    const glm::dmat3 outer = rotation + glm::transpose(rotation) - (trace - 1.0) * glm::dmat3(1.0);
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      if (glm::length(outer[i]) > glm::length(outer[longest])) longest = i;
    }
    return glm::normalize(outer[longest]);
  }

  bool known(const glm::dvec3& direction) const {
    return std::any_of(tried_.begin(), tried_.end(), [&](const glm::dvec3& other) {
      return std::abs(glm::dot(direction, other)) > kSameAxis;
    });
  }

  bool loosely(const GroupFrame& frame, const std::vector<glm::dmat3>& elements) const {
    return surface_.maps(frame, elements, kRoughReach * reach_mm_, false);
  }
  bool strictly(const GroupFrame& frame, const std::vector<glm::dmat3>& elements) const {
    return surface_.maps(frame, elements, reach_mm_, false) &&
           surface_.maps(frame, elements, reach_mm_, true);
  }

  void tryAxis(const glm::dvec3& direction) {
    tried_.push_back(direction);
    GroupFrame frame = frameAbout(direction, moments_.centroid_mm);
    const bool any_angle = loosely(frame, unevenTurns(8));
    int order = any_angle ? kLargestOrder : kLargestOrder + 1;
    while (!any_angle && order > 1 && !loosely(frame, withoutIdentity(cyclicGroup(--order)))) {
    }
    if (order == 1) return;
    constexpr int kFewTurns = 16;
    frame = surface_.refined(
        frame,
        order <= kFewTurns ? withoutIdentity(cyclicGroup(order)) : unevenTurns(kFewTurns / 2));
    if (any_angle && strictly(frame, unevenTurns(kFewTurns))) {
      round_ = Axis{frame, 0};
      return;
    }
    while (order > 1 && !strictly(frame, withoutIdentity(cyclicGroup(order)))) --order;
    if (order > 1) axes_.push_back({frame, order});
  }

  Symmetries revolution(const Axis& axis) const {
    const std::vector<glm::dmat3> all = uniformRotations(64);
    if (loosely(axis.frame, all)) {
      const GroupFrame frame = surface_.refined(axis.frame, all);
      if (strictly(frame, all)) return sphere(frame.centre_mm);
    }
    Symmetries result;
    result.continuous.push_back({axis.frame.axes[2], axis.frame.centre_mm});
    const std::vector<glm::dmat3> turns = withHalfTurns(unevenTurns(4));
    if (!loosely(axis.frame, turns)) return result;
    const GroupFrame frame = surface_.refined(axis.frame, turns);
    if (!strictly(frame, turns)) return result;
    result.continuous[0] = {frame.axes[2], frame.centre_mm};
    result.discrete.push_back(motionOf(frame, dihedralGroup(1)[1]));
    return result;
  }

  static Symmetries sphere(const glm::dvec3& centre_mm) {
    Symmetries result;
    for (int i = 0; i < 3; ++i) result.continuous.push_back({glm::dmat3(1.0)[i], centre_mm});
    return result;
  }

  /// Frames of two perpendicular axes of even order; each is x, y of one and y, x of another.
  std::vector<GroupFrame> crossedFrames(int order) const {
    std::vector<GroupFrame> frames;
    for (const Axis& a : axes_) {
      for (const Axis& b : axes_) {
        const glm::dvec3 x = a.frame.axes[2];
        const glm::dvec3 y = b.frame.axes[2];
        const bool crossed = std::abs(glm::dot(x, y)) < 0.1;
        if (!crossed || a.order % order != 0 || b.order % order != 0) continue;
        const glm::dvec3 other = glm::normalize(y - glm::dot(y, x) * x);
        frames.push_back({glm::dmat3(x, other, glm::cross(x, other)), a.frame.centre_mm});
        if (frames.size() == 8) return frames;
      }
    }
    return frames;
  }

  void addPolyhedral(std::vector<Candidate>& candidates) const {
    const auto steep =
        std::count_if(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.order >= 3; });
    if (steep < 2) return;
    for (const GroupFrame& frame : crossedFrames(2)) {
      candidates.push_back({icosahedralGroup(), frame});
      candidates.push_back({tetrahedralGroup(), frame});
    }
    for (const GroupFrame& frame : crossedFrames(4)) {
      candidates.push_back({octahedralGroup(), frame});
    }
  }

  void addDihedral(std::vector<Candidate>& candidates, const Axis& main) const {
    for (const Axis& axis : axes_) {
      const glm::dvec3 z = main.frame.axes[2];
      const glm::dvec3 x = axis.frame.axes[2];
      if (std::abs(glm::dot(z, x)) > 0.1 || axis.order % 2 != 0) continue;
      const glm::dvec3 y = glm::normalize(glm::cross(z, x));
      const GroupFrame frame = {glm::dmat3(glm::cross(y, z), y, z), main.frame.centre_mm};
      candidates.push_back({dihedralGroup(main.order), frame});
      return;
    }
  }

  Symmetries largestGroup() const {
    std::vector<Candidate> candidates;
    addPolyhedral(candidates);
    for (const Axis& axis : axes_) {
      candidates.push_back({cyclicGroup(axis.order), axis.frame});
      addDihedral(candidates, axis);
    }
    std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
      return a.group.size() > b.group.size();
    });
    for (const Candidate& candidate : candidates) {
      const std::vector<glm::dmat3> elements = withoutIdentity(candidate.group);
      if (!loosely(candidate.frame, elements)) continue;
      const GroupFrame frame = surface_.refined(candidate.frame, elements);
      if (!strictly(frame, elements)) continue;
      Symmetries result;
      for (const glm::dmat3& element : elements) {
        result.discrete.push_back(motionOf(frame, element));
      }
      return result;
    }
    return {};
  }

  SurfaceMatch surface_;
  AreaMoments moments_;
  double reach_mm_;
  double radius_mm_ = 0.0;  ///< about the centroid
  std::vector<glm::dvec3> tried_;
  std::vector<Axis> axes_;
  std::optional<Axis> round_;
};

}  // namespace

void SymmetryOptions::check() const {
  RP_CHECK(tolerance > 0.0 && tolerance <= 0.2, "symmetry tolerance must be in (0, 0.2]");
}

Symmetries findSymmetries(const Mesh& mesh, const SymmetryOptions& options) {
  options.check();
  checkMesh(mesh);
  return Finder(cleaned(mesh), options).find();
}

}  // namespace rangepose
