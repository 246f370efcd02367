#include "peers/verdict.h"

#include <algorithm>
#include <cmath>

#include "pipeline/candidates.h"
#include "pipeline/pose_distance.h"
#include "stages/check_host.h"

namespace rangepose::peers {
namespace {

double checked(const DepthImage& depth,
               const ReferenceObject& object,
               const Pose& pose,
               const CheckOptions& options,
               int pixels) {
  const SurfaceWindow window =
      wholeWindowAround(depth.camera, pose * object.center_mm, object.radius_mm, pixels);
  if (window.width == 0) return 0.0;
  const Image<SurfaceTexel> surface = host::renderSurface(object.mesh, depth.camera, pose, window);
  return host::check(surface, window, depth, options).score;
}

}  // namespace

double Verdict::score(const ReferenceObject& object, const Pose& pose) const {
  constexpr int kPixels = 112;
  return checked(depth_, object, pose, checkOptionsFor(object, noise_mm_), kPixels);
}

double Verdict::glance(const ReferenceObject& object, const Pose& pose) const {
  constexpr int kPixels = 32;
  CheckOptions options;
  options.tolerance_mm = std::max(0.05 * object.diameter_mm, 3.0 * noise_mm_);
  options.max_tilt_rad = 1.2;
  options.border = 0.0;  // an outline is not met by a rough pose
  return checked(depth_, object, pose, options, kPixels);
}

Cloud Verdict::visible(const ReferenceObject& object,
                       const Pose& pose,
                       double reach_mm,
                       int count) const {
  constexpr int kPixels = 112;
  const SurfaceWindow window =
      windowAround(depth_.camera, pose * object.center_mm, object.radius_mm, kPixels);
  if (window.width == 0) return {};
  Image<SurfaceTexel> surface = host::renderSurface(object.mesh, depth_.camera, pose, window);
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const int u = window.x0 + x * window.step;
      const int v = window.y0 + y * window.step;
      if (!depth_.depth_mm.contains(u, v)) continue;
      const double seen = static_cast<double>(depth_.depth_mm.at(u, v));
      SurfaceTexel& texel = surface.at(x, y);
      if (seen > 0.0 && seen < static_cast<double>(texel.w) - reach_mm) texel.w = 0.0f;
    }
  }
  return pointsOfSurface(surface, depth_.camera, window, pose, count);
}

std::vector<glm::ivec2> Verdict::explained(const ReferenceObject& object, const Pose& pose) const {
  const int all = std::max(depth_.camera.width, depth_.camera.height);
  const SurfaceWindow window =
      windowAround(depth_.camera, pose * object.center_mm, object.radius_mm, all);
  std::vector<glm::ivec2> pixels;
  if (window.width == 0) return pixels;
  const Image<SurfaceTexel> surface = host::renderSurface(object.mesh, depth_.camera, pose, window);
  const double tolerance = 2.0 * checkOptionsFor(object, noise_mm_).tolerance_mm;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const glm::ivec2 at(window.x0 + x, window.y0 + y);
      const double model = static_cast<double>(surface.at(x, y).w);
      const double seen = static_cast<double>(depth_.depth_mm.at(at.x, at.y));
      if (model > 0.0 && std::abs(model - seen) < tolerance) pixels.push_back(at);
    }
  }
  return pixels;
}

std::vector<Scored> Verdict::withoutRivals(std::vector<Scored> poses,
                                           const std::vector<ReferenceObject>& objects,
                                           double min_score) const {
  constexpr double kMostShared = 0.25;
  constexpr double kSame = 0.1;  // of the diameter
  std::stable_sort(poses.begin(), poses.end(), [](const Scored& a, const Scored& b) {
    return a.score > b.score;
  });
  std::vector<PoseDistance> distances(objects.begin(), objects.end());
  Image<std::uint8_t> taken(depth_.depth_mm.width(), depth_.depth_mm.height(), 0);
  std::vector<Scored> kept;
  for (const Scored& pose : poses) {
    if (pose.score < min_score) break;
    const auto index = static_cast<std::size_t>(pose.object);
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Scored& other) {
      return other.object == pose.object &&
             distances[index].below(kSame, other.camera_from_object, pose.camera_from_object);
    });
    if (known) continue;
    const std::vector<glm::ivec2> pixels = explained(objects[index], pose.camera_from_object);
    const auto shared = std::count_if(pixels.begin(), pixels.end(), [&](const glm::ivec2& at) {
      return taken.at(at.x, at.y) != 0;
    });
    if (static_cast<double>(shared) > kMostShared * static_cast<double>(pixels.size())) continue;
    for (const glm::ivec2& at : pixels) taken.at(at.x, at.y) = 1;
    kept.push_back(pose);
  }
  return kept;
}

}  // namespace rangepose::peers
