#include "peers/ppf_matcher.h"

#include <algorithm>
#include <cmath>

namespace rangepose::peers {
namespace {

/// Six columns: position and normal. OpenCV's limits are made for objects of a size near 1.
cv::Mat rowsOf(const Cloud& cloud, double unit_mm) {
  cv::Mat rows(static_cast<int>(cloud.size()), 6, CV_32F);
  const float scale = static_cast<float>(1.0 / unit_mm);
  for (int i = 0; i < rows.rows; ++i) {
    const SurfacePoint& point = cloud[static_cast<std::size_t>(i)];
    float* row = rows.ptr<float>(i);
    for (int k = 0; k < 3; ++k) {
      row[k] = point.position_mm[k] * scale;
      row[k + 3] = point.normal[k];
    }
  }
  return rows;
}

Pose poseOf(const cv::Matx44d& matrix, double unit_mm) {
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation[column][row] = matrix(row, column);
    pose.translation_mm[row] = matrix(row, 3) * unit_mm;
  }
  pose.rotation = orthonormalized(pose.rotation);
  return pose;
}

bool finite(const Pose& pose) {
  double sum = glm::dot(pose.translation_mm, pose.translation_mm);
  for (int k = 0; k < 3; ++k) sum += glm::dot(pose.rotation[k], pose.rotation[k]);
  return std::isfinite(sum);
}

/// All that any view shows; the inside that nobody sees would only add wrong pairs.
Cloud visibleSurface(const ReferenceObject& object) {
  constexpr std::size_t kViews = 128;
  const std::size_t stride = std::max<std::size_t>(1, object.views.size() / kViews);
  Cloud surface;
  for (std::size_t view = 0; view < object.views.size(); view += stride) {
    const Cloud seen = pointsOfView(object, static_cast<int>(view), object.size * object.size);
    surface.insert(surface.end(), seen.begin(), seen.end());
  }
  return surface;
}

Cloud moved(const Cloud& cloud, const Pose& pose) {
  Cloud result = cloud;
  for (SurfacePoint& point : result) {
    point.position_mm = glm::vec3(pose * glm::dvec3(point.position_mm));
    point.normal = glm::vec3(pose.rotation * glm::dvec3(point.normal));
  }
  return result;
}

}  // namespace

PpfMatcher::PpfMatcher(const ReferenceObject& object, const PpfOptions& options)
    : diameter_mm_(object.diameter_mm),
      spacing_mm_(options.spacing * object.diameter_mm),
      options_(options) {
  constexpr double kNoClusters = 1e-9;
  constexpr double kWider = 1.05;
  const Cloud surface = visibleSurface(object);
  Cloud points = thinned(surface, spacing_mm_);
  while (static_cast<int>(points.size()) > options.most_points) {
    spacing_mm_ *= kWider;
    points = thinned(surface, spacing_mm_);
  }
  detector_ = std::make_unique<cv::ppf_match_3d::PPF3DDetector>(
      options.distance_step, options.distance_step, options.angles);
  detector_->setSearchParams(kNoClusters, kNoClusters);
  detector_->trainModel(rowsOf(points, diameter_mm_));
}

std::vector<PpfHypothesis> PpfMatcher::match(const Cloud& crop) {
  constexpr std::size_t kFewest = 30;
  // Cells of OpenCV's own thinning: a share of the crop's box that leaves the points as they are.
  constexpr double kCells = 1.0 / 64.0;
  std::vector<PpfHypothesis> hypotheses;
  if (crop.size() < kFewest) return hypotheses;
  std::vector<cv::ppf_match_3d::Pose3DPtr> found;
  detector_->match(rowsOf(crop, diameter_mm_), found, options_.reference_share, kCells);
  for (const auto& pose : found) {
    const PpfHypothesis hypothesis{poseOf(pose->pose, diameter_mm_),
                                   static_cast<double>(pose->numVotes)};
    if (finite(hypothesis.camera_from_object)) hypotheses.push_back(hypothesis);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const auto& a, const auto& b) {
    return a.votes > b.votes;
  });
  return hypotheses;
}

Pose PpfMatcher::align(const Cloud& surface,
                       const Cloud& scene,
                       const Pose& start,
                       const PpfIcpOptions& options) const {
  constexpr std::size_t kFewest = 30;
  if (surface.size() < kFewest || scene.size() < kFewest) return start;
  cv::ppf_match_3d::ICP icp(
      options.iterations, options.tolerance, options.rejection, options.levels);
  double residual = 0.0;
  cv::Matx44d change = cv::Matx44d::eye();
  icp.registerModelToScene(
      rowsOf(moved(surface, start), diameter_mm_), rowsOf(scene, diameter_mm_), residual, change);
  Pose pose = poseOf(change, diameter_mm_) * start;
  pose.rotation = orthonormalized(pose.rotation);
  return finite(pose) ? pose : start;
}

}  // namespace rangepose::peers
