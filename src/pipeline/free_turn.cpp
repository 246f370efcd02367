#include "pipeline/free_turn.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/surface_sample.h"
#include "pipeline/explained_pixels.h"

namespace rangepose {
namespace {

constexpr std::size_t kFewestPoints = 30;
/// Of the squared shifts along normals: what a plane leaves open must not be divided by 0.
constexpr double kStiffness = 1e-6;

struct SeenPoint {
  glm::dvec3 at_mm;  ///< of the part, camera frame
  glm::dvec3 normal;
};

std::vector<SeenPoint> seenPoints(const Image<SurfaceTexel>& surface,
                                  const SurfaceWindow& window,
                                  const DepthImage& depth,
                                  double tolerance_mm) {
  std::vector<SeenPoint> points;
  forEachMeasured(
      surface, window, depth, [&](const SurfaceTexel& texel, float seen_mm, std::int32_t at) {
        if (std::abs(texel.w - seen_mm) > tolerance_mm) return;
        const int u = at % depth.camera.width;
        const int v = at / depth.camera.width;
        points.push_back({depth.camera.unproject(u, v, static_cast<double>(texel.w)),
                          {texel.x, texel.y, texel.z}});
      });
  return points;
}

/// The axis of the least change, and a point of it; the change is that by one radian.
FreeTurn leastTurn(const std::vector<SeenPoint>& points) {
  const double count = static_cast<double>(points.size());
  glm::dvec3 middle(0.0);
  for (const SeenPoint& point : points) middle += point.at_mm / count;
  glm::dmat3 shifts(kStiffness * count);
  glm::dmat3 both(0.0);
  glm::dmat3 turns(0.0);
  for (const SeenPoint& point : points) {
    const glm::dvec3 arm = glm::cross(point.at_mm - middle, point.normal);
    shifts += glm::outerProduct(point.normal, point.normal);
    both += glm::outerProduct(arm, point.normal);
    turns += glm::outerProduct(arm, arm);
  }
  // With the best shift for each turn.
  const glm::dmat3 best_shift = glm::inverse(shifts) * glm::transpose(both);
  glm::dmat3 change = turns - both * best_shift;
  const glm::dmat3 axes = diagonalise(change);
  int least = 0;
  for (int i = 1; i < 3; ++i) least = change[i][i] < change[least][least] ? i : least;
  FreeTurn turn;
  turn.axis = glm::normalize(axes[least]);
  // The shift along the axis would make it a screw.
  turn.on_axis_mm = middle - glm::cross(turn.axis, best_shift * turn.axis);
  double sum = 0.0;
  for (const SeenPoint& point : points) {
    const double off = glm::dot(point.normal, glm::cross(turn.axis, point.at_mm - turn.on_axis_mm));
    sum += off * off;
  }
  turn.change_mm = std::sqrt(sum / count);
  return turn;
}

}  // namespace

std::optional<FreeTurn> freestTurn(const Image<SurfaceTexel>& surface,
                                   const SurfaceWindow& window,
                                   const DepthImage& depth,
                                   const ReferenceObject& object,
                                   const Pose& camera_from_object,
                                   double tolerance_mm) {
  const std::vector<SeenPoint> points = seenPoints(surface, window, depth, tolerance_mm);
  if (points.size() < kFewestPoints) return std::nullopt;
  FreeTurn turn = leastTurn(points);
  double arm_mm = 0.0;
  for (const glm::vec3& vertex : object.mesh.vertices) {
    const glm::dvec3 at_mm = camera_from_object * glm::dvec3(vertex);
    arm_mm = std::max(arm_mm, glm::length(glm::cross(turn.axis, at_mm - turn.on_axis_mm)));
  }
  turn.change_mm *= kTurnedApart * object.diameter_mm / arm_mm;
  return turn;
}

std::vector<Candidate> turnedAbout(const FreeTurn& line, const Candidate& candidate, int steps) {
  std::vector<Candidate> copies;
  for (int step = 1; step < steps; ++step) {
    const glm::dmat3 turn = rotationFromVector(2.0 * std::numbers::pi * step / steps * line.axis);
    Candidate& copy = copies.emplace_back(candidate);
    copy.pose.rotation = turn * candidate.pose.rotation;
    copy.pose.translation_mm =
        line.on_axis_mm + turn * (candidate.pose.translation_mm - line.on_axis_mm);
  }
  return copies;
}

}  // namespace rangepose
