#include "pipeline/pose_distance.h"

#include <algorithm>
#include <limits>

namespace rangepose {
namespace {

/// Where the points lie [share of the sphere's radius]: as far out as most of a part's surface.
constexpr double kReach = 0.6;

std::vector<glm::dvec3> pointsOf(const ReferenceObject& object) {
  const std::vector<SymmetryAxis>& axes = object.symmetries.continuous;
  if (axes.size() > 1) return {object.center_mm};
  const double reach_mm = kReach * object.radius_mm;
  if (axes.size() == 1) {
    const glm::dvec3& along = axes.front().direction;
    const glm::dvec3 middle =
        axes.front().point_mm + glm::dot(object.center_mm - axes.front().point_mm, along) * along;
    return {middle + reach_mm * along, middle - reach_mm * along};
  }
  std::vector<glm::dvec3> points;
  for (int corner = 0; corner < 6; ++corner) {
    points.push_back(object.center_mm);
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
    : center_mm_(object.center_mm),
      diameter_mm_(object.diameter_mm),
      points_mm_(pointsOf(object)),
      copies_mm_{points_mm_} {
  for (const Pose& symmetric : object.symmetries.discrete) {
    std::vector<glm::dvec3>& copy = copies_mm_.emplace_back();
    for (const glm::dvec3& point : points_mm_) copy.push_back(symmetric * point);
  }
}

double PoseDistance::operator()(const Pose& a, const Pose& b) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<glm::dvec3>& copy : copies_mm_)
    least = std::min(least, meanDistance(a, points_mm_, b, copy));
  return least / diameter_mm_;
}

double PoseDistance::centersWithinMm(double limit) const {
  // Symmetries leave the centre where it is (the sphere around the part has its symmetries), but
  // for what they are found to within.
  constexpr double kSlack = 0.02;
  return (limit + kSlack) * diameter_mm_;
}

bool PoseDistance::below(double limit, const Pose& a, const Pose& b) const {
  return glm::distance(a * center_mm_, b * center_mm_) < centersWithinMm(limit) &&
         (*this)(a, b) < limit;
}

bool PoseList::holds(double limit, const Pose& pose) const {
  const glm::dvec3 center_mm = pose * distance_.center_mm_;
  const double within_mm = distance_.centersWithinMm(limit);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const glm::dvec3 shift = centers_mm_[i] - center_mm;
    if (glm::dot(shift, shift) < within_mm * within_mm && distance_(poses_[i], pose) < limit)
      return true;
  }
  return false;
}

void PoseList::add(const Pose& pose) {
  poses_.push_back(pose);
  centers_mm_.push_back(pose * distance_.center_mm_);
}

}  // namespace rangepose
