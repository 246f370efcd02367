#include "eval/pose_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rangepose {
namespace {

/// Largest step of a vertex from one copy to the next, as a share of the diameter (BOP's
/// max_sym_disc_step).
constexpr double kCopyStep = 0.01;

double distanceToAxis(const SymmetryAxis& axis, const glm::dvec3& point) {
  return glm::length(glm::cross(point - axis.point_mm, axis.direction));
}

double radiusAbout(const SymmetryAxis& axis, const std::vector<glm::dvec3>& points) {
  double radius = 0.0;
  for (const glm::dvec3& point : points) radius = std::max(radius, distanceToAxis(axis, point));
  return radius;
}

std::vector<glm::dvec3> farthestFirst(const Mesh& mesh, const glm::dvec3& mean) {
  std::vector<glm::dvec3> points(mesh.vertices.begin(), mesh.vertices.end());
  std::stable_sort(points.begin(), points.end(), [&mean](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dot(a - mean, a - mean) > glm::dot(b - mean, b - mean);
  });
  return points;
}

const Mesh& checked(const Mesh& mesh) {
  checkMesh(mesh);
  return mesh;
}

glm::dvec3 meanOf(const Mesh& mesh) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& vertex : mesh.vertices) sum += glm::dvec3(vertex);
  return sum / static_cast<double>(mesh.vertices.size());
}

Pose turned(const SymmetryAxis& axis, double angle_rad) {
  Pose pose;
  pose.rotation = rotationFromVector(axis.direction * angle_rad);
  pose.translation_mm = axis.point_mm - pose.rotation * axis.point_mm;
  return pose;
}

bool isSphere(const Symmetries& symmetries) { return symmetries.continuous.size() > 1; }

/// The true pose of a sphere about `center`, turned as the estimate is.
Pose turnedLike(const Pose& estimate, const Pose& truth, const glm::dvec3& center) {
  return {estimate.rotation, truth * center - estimate.rotation * center};
}

/// A symmetric copy of the truth and the error against it.
struct Closest {
  Pose copy;
  double error = kNoLimit;
};

/// Golden-section search about one axis, within one step of the best copy so far. The error of a
/// turn away from the best one grows on both sides of it, as the distances of all vertices do.
template <typename Error>
void refineAbout(const SymmetryAxis& axis, double step_rad, const Error& error, Closest& best) {
  constexpr int kHalvings = 60;
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  const Pose middle = best.copy;
  const auto at = [&](double angle) { return error(middle * turned(axis, angle), kNoLimit); };
  double low = -step_rad;
  double high = step_rad;
  double left = high - ratio * (high - low);
  double right = low + ratio * (high - low);
  double error_left = at(left);
  double error_right = at(right);
  for (int i = 0; i < kHalvings; ++i) {
    if (error_left < error_right) {
      high = std::exchange(right, left);
      error_right = error_left;
      left = high - ratio * (high - low);
      error_left = at(left);
    } else {
      low = std::exchange(left, right);
      error_left = error_right;
      right = low + ratio * (high - low);
      error_right = at(right);
    }
  }
  const Pose copy = middle * turned(axis, 0.5 * (low + high));
  const double refined = error(copy, kNoLimit);
  if (refined < best.error) best = {copy, refined};
}

/// The copy of the truth with the smallest error(copy, limit); that function may stop early with
/// any value above its limit. Copies lie so close together that one with an error within `limit`
/// has a neighbour within twice of it.
template <typename Error>
Closest closestCopy(const ErrorModel& model,
                    const Pose& estimate,
                    const Pose& truth,
                    double limit,
                    const Error& error) {
  Closest best;
  if (isSphere(model.symmetries())) {
    best.copy = turnedLike(
        estimate, truth, fixedPoint(model.symmetries().continuous, model.sphere().center_mm));
    best.error = error(best.copy, kNoLimit);
    return best;
  }
  for (const Pose& symmetry : model.copies()) {
    const Pose copy = truth * symmetry;
    const double value = error(copy, std::min(best.error, 2.0 * limit));
    if (value < best.error) best = {copy, value};
  }
  if (best.error == 0.0 || !(best.error <= 2.0 * limit)) return best;
  for (const SymmetryAxis& axis : model.symmetries().continuous) {
    refineAbout(axis, model.stepRad(), error, best);
  }
  return best;
}

/// Mean over the vertices of |estimate x - copy x|; kNoLimit where it is above `limit`. The
/// distance of the mean vertices never exceeds it.
double meanDistance(const ErrorModel& model, const Pose& estimate, const Pose& copy, double limit) {
  if (glm::distance(estimate * model.mean(), copy * model.mean()) > limit) return kNoLimit;
  const double count = static_cast<double>(model.points().size());
  double sum = 0.0;
  for (const glm::dvec3& point : model.points()) {
    sum += glm::distance(estimate * point, copy * point);
    if (sum > limit * count) return kNoLimit;
  }
  return sum / count;
}

Closest closestByVertices(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  return closestCopy(model, estimate, truth, kNoLimit, [&](const Pose& copy, double limit) {
    return meanDistance(model, estimate, copy, limit);
  });
}

}  // namespace

ErrorModel::ErrorModel(const Mesh& mesh, const Symmetries& symmetries)
    : mesh_(checked(mesh)),
      symmetries_(symmetries),
      diameter_mm_(diameter(mesh)),
      diagonal_mm_(boundingBoxDiagonal(mesh)),
      sphere_(boundingSphere(mesh)),
      mean_(meanOf(mesh)),
      points_(farthestFirst(mesh, mean_)),
      tree_(points_) {
  if (isSphere(symmetries)) {
    copies_ = {Pose{}};
    return;
  }
  double radius = 0.0;
  for (const SymmetryAxis& axis : symmetries.continuous) radius = radiusAbout(axis, points_);
  if (!(radius > 0.0)) radius = sphere_.radius_mm;
  const double step = kCopyStep * diameter_mm_;
  copies_ = symmetricPoses(symmetries, radius, step);
  // Somewhat wider than the step of the copies: a minimum between two of them is not missed.
  step_rad_ = std::min(std::numbers::pi / 4.0, 1.5 * step / radius);
}

double addErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  return meanDistance(model, estimate, truth, kNoLimit);
}

double adiErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  const Pose model_from_true = estimate.inverse() * truth;
  double sum = 0.0;
  for (const glm::dvec3& point : model.points()) {
    const glm::dvec3& nearest = model.points()[model.tree().nearest(model_from_true * point)];
    sum += glm::distance(estimate * nearest, truth * point);
  }
  return sum / static_cast<double>(model.points().size());
}

double mssdErrorMm(const ErrorModel& model,
                   const Pose& estimate,
                   const Pose& truth,
                   double limit_mm) {
  const auto largest = [&](const Pose& copy, double limit) {
    double worst = 0.0;
    for (const glm::dvec3& point : model.points()) {
      worst = std::max(worst, glm::distance(estimate * point, copy * point));
      if (worst > limit) break;
    }
    return worst;
  };
  return closestCopy(model, estimate, truth, limit_mm, largest).error;
}

double mspdErrorPx(const ErrorModel& model,
                   const Camera& camera,
                   const Pose& estimate,
                   const Pose& truth,
                   double limit_px) {
  const auto largest = [&](const Pose& copy, double limit) {
    double worst = 0.0;
    for (const glm::dvec3& point : model.points()) {
      const glm::dvec3 a = estimate * point;
      const glm::dvec3 b = copy * point;
      if (!camera.orthographic && !(a.z > 0.0 && b.z > 0.0)) return kNoLimit;
      worst = std::max(worst, glm::distance(camera.project(a), camera.project(b)));
      if (worst > limit) break;
    }
    return worst;
  };
  return closestCopy(model, estimate, truth, limit_px, largest).error;
}

double vertexErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  return closestByVertices(model, estimate, truth).error;
}

Pose nearestCopy(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  return closestByVertices(model, estimate, truth).copy;
}

double rotationErrorRad(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  return rotationAngleModulo(model.symmetries(), estimate.rotation, truth.rotation);
}

double translationErrorMm(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  return glm::distance(estimate.translation_mm, nearestCopy(model, estimate, truth).translation_mm);
}

glm::dvec3 eulerErrorRad(const ErrorModel& model, const Pose& estimate, const Pose& truth) {
  const Pose copy = nearestCopy(model, estimate, truth);
  // estimate = Rz Ry Rx copy; entries are [column][row].
  const glm::dmat3 turn = estimate.rotation * glm::transpose(copy.rotation);
  return {std::abs(std::atan2(turn[1][2], turn[2][2])),
          std::abs(std::asin(std::clamp(turn[0][2], -1.0, 1.0))),
          std::abs(std::atan2(turn[0][1], turn[0][0]))};
}

}  // namespace rangepose
