#include "geometry/surface_match.h"

#include <algorithm>
#include <cmath>

#include "geometry/normal_equations.h"
#include "geometry/surface_sample.h"

namespace rangepose {
namespace {

constexpr int kSamplePoints = 2000;
constexpr int kQuickPoints = 1500;
constexpr int kEvenPoints = 4000;
constexpr std::size_t kMostVertices = 12000;
constexpr std::size_t kPointsPerStep = 6000;
constexpr int kSteps = 8;
constexpr double kDamping = 1e-5;

/// Direction from the surface to a point near it, and the distance.
struct Offset {
  glm::dvec3 direction{0.0};
  double distance_mm = 0.0;
};

Offset offsetFrom(const TriangleTree& tree, const glm::dvec3& point) {
  const NearestPoint nearest = tree.nearest(point);
  const double distance = std::sqrt(nearest.squared_mm2);
  if (distance < 1e-12) return {};
  return {(point - nearest.point_mm) / distance, distance};
}

/// Mixes the two lists so that any first part of the result holds both in proportion.
std::vector<glm::dvec3> mixed(const std::vector<glm::dvec3>& even,
                              const std::vector<glm::vec3>& vertices) {
  std::vector<glm::dvec3> all = even;
  const std::size_t stride = vertices.size() / kMostVertices + 1;
  for (std::size_t i = 0; i < vertices.size(); i += stride) all.emplace_back(vertices[i]);
  // A stride that shares no factor with the length visits each place once.
  std::vector<glm::dvec3> result;
  result.reserve(all.size());
  constexpr std::size_t kPrime = 1000003;
  for (std::size_t i = 0; i < all.size(); ++i) result.push_back(all[i * kPrime % all.size()]);
  return result;
}

}  // namespace

Pose motionOf(const GroupFrame& frame, const glm::dmat3& element) {
  const glm::dmat3 turn = frame.axes * element * glm::transpose(frame.axes);
  return {turn, frame.centre_mm - turn * frame.centre_mm};
}

GroupFrame frameAbout(const glm::dvec3& direction, const glm::dvec3& centre_mm) {
  const glm::dvec3 z = glm::normalize(direction);
  const glm::dvec3 other = std::abs(z.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 y = glm::normalize(glm::cross(z, other));
  return {glm::dmat3(glm::cross(y, z), y, z), centre_mm};
}

SurfaceMatch::SurfaceMatch(const Mesh& mesh)
    : tree_(mesh),
      sample_(surfaceSample(mesh, kSamplePoints)),
      quick_points_(surfaceSample(mesh, kQuickPoints)),
      all_points_(mixed(surfaceSample(mesh, kEvenPoints), mesh.vertices)),
      radius_mm_(boundingSphere(mesh).radius_mm) {}

bool SurfaceMatch::maps(const GroupFrame& frame,
                        const std::vector<glm::dmat3>& elements,
                        double reach_mm,
                        bool thorough) const {
  const std::vector<glm::dvec3>& points = thorough ? all_points_ : quick_points_;
  return std::all_of(elements.begin(), elements.end(), [&](const glm::dmat3& element) {
    const Pose motion = motionOf(frame, element);
    return std::all_of(points.begin(), points.end(), [&](const glm::dvec3& point) {
      return tree_.touches(motion * point, reach_mm);
    });
  });
}

GroupFrame SurfaceMatch::refined(GroupFrame frame, const std::vector<glm::dmat3>& elements) const {
  const std::size_t points = std::clamp(
      kPointsPerStep / std::max<std::size_t>(1, elements.size()), std::size_t{150}, sample_.size());
  for (int step = 0; step < kSteps; ++step) {
    NormalEquations<6> sums;
    for (const glm::dmat3& element : elements) {
      const glm::dmat3 turn = frame.axes * element * glm::transpose(frame.axes);
      for (std::size_t i = 0; i < points; ++i) {
        const glm::dvec3 from = sample_[i] - frame.centre_mm;
        const glm::dvec3 to = turn * from;
        const Offset offset = offsetFrom(tree_, frame.centre_mm + to);
        // A small turn w of the frame moves the point by w x to - turn * (w x from).
        const glm::dvec3 back = offset.direction * turn;
        const glm::dvec3 by_turn =
            (glm::cross(to, offset.direction) - glm::cross(from, back)) / radius_mm_;
        const glm::dvec3 by_shift = offset.direction - back;
        sums.add({by_turn.x, by_turn.y, by_turn.z, by_shift.x, by_shift.y, by_shift.z},
                 offset.distance_mm / radius_mm_);
      }
    }
    const auto x = sums.solve(kDamping);
    const glm::dvec3 turn(x[0], x[1], x[2]);
    frame.axes = orthonormalized(rotationFromVector(turn) * frame.axes);
    frame.centre_mm += radius_mm_ * glm::dvec3(x[3], x[4], x[5]);
    if (glm::length(turn) < 1e-7) break;
  }
  return frame;
}

glm::dmat3 SurfaceMatch::refinedRotation(const glm::dmat3& rotation,
                                         const glm::dvec3& centre_mm) const {
  constexpr std::size_t kPoints = 400;
  glm::dmat3 turn = rotation;
  for (int step = 0; step < kSteps; ++step) {
    NormalEquations<3> sums;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const glm::dvec3 to = turn * (sample_[i] - centre_mm);
      const Offset offset = offsetFrom(tree_, centre_mm + to);
      const glm::dvec3 by_turn = glm::cross(to, offset.direction) / radius_mm_;
      sums.add({by_turn.x, by_turn.y, by_turn.z}, offset.distance_mm / radius_mm_);
    }
    const auto x = sums.solve(kDamping);
    turn = orthonormalized(rotationFromVector({x[0], x[1], x[2]}) * turn);
    if (glm::length(glm::dvec3(x[0], x[1], x[2])) < 1e-5) break;
  }
  return turn;
}

}  // namespace rangepose
