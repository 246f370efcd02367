#include "pipeline/pose_distance.h"

#include <algorithm>
#include <limits>

namespace rangepose {
namespace {

/// Where the points lie [share of the sphere's radius]: as far out as most of a part's surface.
constexpr double kReach = 0.6;

/// The point that the symmetries leave in place: the mean of where they take the sphere's centre.
/// Where they leave none in place, as symmetries that are known roughly do, it is near all of them.
glm::dvec3 middleOf(const ReferenceObject& object) {
  const Symmetries& symmetries = object.symmetries;
  const glm::dvec3 start = fixedPoint(symmetries.continuous, object.center_mm);
  glm::dvec3 sum = start;
  for (const Pose& symmetric : symmetries.discrete) sum += symmetric * start;
  return fixedPoint(symmetries.continuous,
                    sum / static_cast<double>(symmetries.discrete.size() + 1));
}

/// Points about `middle`, which is their mean.
std::vector<glm::dvec3> pointsOf(const ReferenceObject& object, const glm::dvec3& middle) {
  const std::vector<SymmetryAxis>& axes = object.symmetries.continuous;
  if (axes.size() > 1) return {middle};
  const double reach_mm = kReach * object.radius_mm;
  if (axes.size() == 1) {
    const glm::dvec3 along = reach_mm * axes.front().direction;
    return {middle + along, middle - along};
  }
  std::vector<glm::dvec3> points;
  for (int corner = 0; corner < 6; ++corner) {
    points.push_back(middle);
    points.back()[corner / 2] += corner % 2 == 0 ? reach_mm : -reach_mm;
  }
  return points;
}

double meanDistance(const Pose& a,
                    const std::vector<glm::dvec3>& points_a,
                    const Pose& b,
                    const std::vector<glm::dvec3>& points_b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points_a.size(); ++i)
    sum += glm::distance(a * points_a[i], b * points_b[i]);
  return sum / static_cast<double>(points_a.size());
}

}  // namespace

PoseDistance::PoseDistance(const ReferenceObject& object)
    : middle_mm_(middleOf(object)),
      diameter_mm_(object.diameter_mm),
      points_mm_(pointsOf(object, middle_mm_)),
      copies_mm_{points_mm_} {
  for (const Pose& symmetric : object.symmetries.discrete) {
    std::vector<glm::dvec3>& copy = copies_mm_.emplace_back();
    for (const glm::dvec3& point : points_mm_) copy.push_back(symmetric * point);
    const double moved_mm = glm::distance(symmetric * middle_mm_, middle_mm_);
    most_moved_mm_ = std::max(most_moved_mm_, moved_mm);
  }
}

double PoseDistance::operator()(const Pose& a, const Pose& b) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<glm::dvec3>& copy : copies_mm_)
    least = std::min(least, meanDistance(a, points_mm_, b, copy));
  return least / diameter_mm_;
}

double PoseDistance::middlesWithinMm(double limit) const {
  // The mean distance of points is no less than the distance of their means, and that of a copy is
  // no farther from the middle than a symmetry moves it.
  constexpr double kRounding = 1e-9;
  return (limit + kRounding) * diameter_mm_ + most_moved_mm_;
}

bool PoseDistance::below(double limit, const Pose& a, const Pose& b) const {
  return glm::distance(a * middle_mm_, b * middle_mm_) < middlesWithinMm(limit) &&
         (*this)(a, b) < limit;
}

bool PoseList::holds(double limit, const Pose& pose) const {
  const glm::dvec3 middle_mm = pose * distance_.middle_mm_;
  const double within_mm = distance_.middlesWithinMm(limit);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const glm::dvec3 shift = middles_mm_[i] - middle_mm;
    if (glm::dot(shift, shift) < within_mm * within_mm && distance_(poses_[i], pose) < limit)
      return true;
  }
  return false;
}

void PoseList::add(const Pose& pose) {
  poses_.push_back(pose);
  middles_mm_.push_back(pose * distance_.middle_mm_);
}

}  // namespace rangepose
