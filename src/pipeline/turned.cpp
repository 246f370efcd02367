#include "pipeline/turned.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/surface_sample.h"

namespace rangepose {
namespace {

struct Frame {
  glm::dvec3 center_mm{0.0};
  glm::dmat3 axes{1.0};  ///< columns, the longest first
};

/// Of the measured points.
Frame principalFrame(const std::vector<std::int32_t>& pixels, const DepthImage& depth) {
  std::vector<glm::dvec3> points;
  points.reserve(pixels.size());
  Frame frame;
  for (const std::int32_t at : pixels) {
    const int u = at % depth.camera.width;
    const int v = at / depth.camera.width;
    points.push_back(depth.camera.unproject(u, v, static_cast<double>(depth.depth_mm.at(u, v))));
    frame.center_mm += points.back();
  }
  frame.center_mm /= static_cast<double>(points.size());
  glm::dmat3 covariance(0.0);
  for (const glm::dvec3& point : points) {
    const glm::dvec3 off = point - frame.center_mm;
    covariance += glm::outerProduct(off, off);
  }
  const glm::dmat3 axes = diagonalise(covariance);
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return covariance[a][a] > covariance[b][b];
  });
  for (int i = 0; i < 3; ++i) frame.axes[i] = axes[order[static_cast<std::size_t>(i)]];
  return frame;
}

/// The view that looks at the object as the camera does.
int viewFrom(const ReferenceObject& object, const Pose& pose, const Camera& camera) {
  const glm::dvec3 ray = glm::transpose(pose.rotation) * camera.viewingRay(pose * object.center_mm);
  int best = 0;
  double nearest = -2.0;
  for (int view = 0; view < static_cast<int>(object.views.size()); ++view) {
    const glm::dmat3& rotation = object.views[static_cast<std::size_t>(view)].rotation;
    const double cosine = glm::dot(glm::transpose(rotation)[2], ray);
    if (cosine > nearest) {
      nearest = cosine;
      best = view;
    }
  }
  return best;
}

}  // namespace

std::vector<Candidate> turnedCopies(const Candidate& candidate,
                                    const std::vector<std::int32_t>& pixels,
                                    const DepthImage& depth,
                                    const ReferenceObject& object,
                                    const AreaMoments& own) {
  if (pixels.empty()) return {};
  constexpr std::array<int, 3> kSteps{8, 4, 4};  // of a full turn
  std::vector<Candidate> copies;
  const auto addTurned = [&](const glm::dvec3& axis, const glm::dvec3& center_mm, double angle) {
    const glm::dmat3 turn = rotationFromVector(angle * axis);
    Candidate& copy = copies.emplace_back(candidate);
    copy.pose.rotation = turn * candidate.pose.rotation;
    copy.pose.translation_mm = center_mm + turn * (candidate.pose.translation_mm - center_mm);
    copy.view = viewFrom(object, copy.pose, depth.camera);
  };
  for (int axis = 0; axis < 3; ++axis) {
    addTurned(candidate.pose.rotation * own.axes[axis],
              candidate.pose * own.centroid_mm,
              std::numbers::pi);
  }
  const Frame frame = principalFrame(pixels, depth);
  for (int axis = 0; axis < 3; ++axis) {
    const int steps = kSteps[static_cast<std::size_t>(axis)];
    for (int step = 1; step < steps; ++step) {
      addTurned(frame.axes[axis], frame.center_mm, 2.0 * std::numbers::pi * step / steps);
    }
  }
  return copies;
}

}  // namespace rangepose
