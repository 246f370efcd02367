#include "pipeline/freedom.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "pipeline/explained_pixels.h"
#include "pipeline/refine.h"
#include "stages/resample_host.h"

namespace rangepose {
namespace {

/// A part is this wide in a view along a direction [px]; less where the parts lie far apart.
constexpr double kPartPx = 64.0;
constexpr double kMaxViewPx = 1024.0;

/// The same rays as those of the virtual camera, for rendering.
Camera parallelCamera(const OrthoCamera& ortho) {
  Camera camera;
  camera.width = ortho.width;
  camera.height = ortho.height;
  camera.cx = 0.5 * ortho.width - 0.5;
  camera.cy = 0.5 * ortho.height - 0.5;
  camera.orthographic = true;
  camera.pixel_size_mm = ortho.pixel_mm;
  return camera;
}

/// Any rotation whose z is the unit vector `direction`.
glm::dmat3 frameAlong(const glm::dvec3& direction) {
  const glm::dvec3 aside = std::abs(direction.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 y = glm::normalize(glm::cross(direction, aside));
  return {glm::cross(y, direction), y, direction};
}

struct PartView {
  SurfaceWindow window;
  Image<SurfaceTexel> surface;
};

PartView viewOf(const ReferenceObject& object, const Camera& camera, const Pose& pose) {
  constexpr int kNoLimit = 1 << 20;
  PartView view;
  view.window = windowAround(camera, pose * object.center_mm, object.radius_mm, kNoLimit);
  view.surface = host::renderSurface(object.mesh, camera, pose, view.window);
  return view;
}

/// From the camera to what it measured farthest away [mm].
double farthestMm(const DepthImage& depth) {
  constexpr int kRowsPerPiece = 16;
  std::vector<double> of_rows(static_cast<std::size_t>(depth.depth_mm.height()), 0.0);
  parallelForEach(of_rows.size(), kRowsPerPiece, [&](std::size_t y) {
    double farthest_mm2 = 0.0;
    const float* const row = depth.depth_mm.row(static_cast<int>(y));
    for (int x = 0; x < depth.depth_mm.width(); ++x) {
      if (row[x] == 0.0f) continue;
      const glm::dvec3 point =
          depth.camera.unproject(x, static_cast<double>(y), static_cast<double>(row[x]));
      farthest_mm2 = std::max(farthest_mm2, glm::dot(point, point));
    }
    of_rows[y] = std::sqrt(farthest_mm2);
  });
  return of_rows.empty() ? 0.0 : *std::max_element(of_rows.begin(), of_rows.end());
}

/// Calls use(x, y, texel) for the pixels of the camera that show the part.
template <typename Use>
void forEachTexel(const PartView& view, const Use& use) {
  for (int y = 0; y < view.surface.height(); ++y) {
    for (int x = 0; x < view.surface.width(); ++x) {
      const SurfaceTexel& texel = view.surface.at(x, y);
      if (texel.w > 0.0f) use(view.window.x0 + x, view.window.y0 + y, texel);
    }
  }
}

/// The nearest part at each pixel.
struct NearestParts {
  Image<float> depth_mm;
  Image<int> part;

  NearestParts(const std::vector<PartView>& views, const Camera& camera)
      : depth_mm(camera.width, camera.height, std::numeric_limits<float>::infinity()),
        part(camera.width, camera.height, -1) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      forEachTexel(views[i], [&](int x, int y, const SurfaceTexel& texel) {
        if (!(texel.w < depth_mm.at(x, y))) return;
        depth_mm.at(x, y) = texel.w;
        part.at(x, y) = static_cast<int>(i);
      });
    }
  }
};

}  // namespace

FoundScene::FoundScene(const std::vector<PoseEstimate>& poses,
                       const DepthImage& depth,
                       double noise_mm,
                       const ReferenceDatabase& database)
    : poses_(poses),
      depth_(depth),
      noise_mm_(noise_mm),
      database_(database),
      unexplained_(depth.depth_mm.width(), depth.depth_mm.height(), 1) {
  std::vector<std::vector<std::int32_t>> explained(poses_.size());
  parallelForEach(poses_.size(), 1, [&](std::size_t i) {
    const ReferenceObject& object = objectOf(poses_[i]);
    const PartView view = viewOf(object, depth_.camera, poses_[i].pose);
    const double same_mm = sameSurfaceMm(toleranceFor(object, noise_mm_));
    explained[i] = explainedPixels(view.surface, view.window, depth_, same_mm);
  });
  for (const std::vector<std::int32_t>& pixels : explained) {
    for (const std::int32_t at : pixels) unexplained_.data()[at] = 0;
  }
  reach_mm_ = farthestMm(depth_);
  for (const PoseEstimate& pose : poses_) {
    const ReferenceObject& object = objectOf(pose);
    reach_mm_ = std::max(reach_mm_, glm::length(pose.pose * object.center_mm) + object.radius_mm);
  }
}

const ReferenceObject& FoundScene::objectOf(const PoseEstimate& pose) const {
  return database_.objects.at(static_cast<std::size_t>(pose.object));
}

OrthoCamera FoundScene::viewAlong(const glm::dvec3& direction) const {
  OrthoCamera view;
  view.camera_from_ortho.rotation = frameAlong(direction);
  const glm::dmat3 turned = glm::transpose(view.camera_from_ortho.rotation);
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  double smallest_mm = std::numeric_limits<double>::max();
  for (const PoseEstimate& pose : poses_) {
    const ReferenceObject& object = objectOf(pose);
    const glm::dvec3 center = turned * (pose.pose * object.center_mm);
    low = glm::min(low, center - object.radius_mm);
    high = glm::max(high, center + object.radius_mm);
    smallest_mm = std::min(smallest_mm, object.diameter_mm);
  }
  const glm::dvec3 size = high - low;
  view.pixel_mm = std::max(smallest_mm / kPartPx, std::max(size.x, size.y) / kMaxViewPx);
  view.width = static_cast<int>(std::ceil(size.x / view.pixel_mm)) + 1;
  view.height = static_cast<int>(std::ceil(size.y / view.pixel_mm)) + 1;
  // From so far back that all lies in front of it.
  const glm::dvec3 middle(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), -1.01 * reach_mm_ - 1.0);
  view.camera_from_ortho.translation_mm = view.camera_from_ortho.rotation * middle;
  return view;
}

std::vector<double> FoundScene::freedom(const glm::dvec3& direction) const {
  if (poses_.empty()) return {};
  const OrthoCamera ortho = viewAlong(direction);
  const Camera camera = parallelCamera(ortho);
  const Pose ortho_from_camera = ortho.camera_from_ortho.inverse();
  std::vector<PartView> views(poses_.size());
  parallelForEach(poses_.size(), 1, [&](std::size_t i) {
    views[i] = viewOf(objectOf(poses_[i]), camera, ortho_from_camera * poses_[i].pose);
  });
  const NearestParts nearest(views, camera);
  const Image<float> measured_px = host::resample(depth_, unexplained_, ortho);
  std::vector<double> shares;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const double same_mm = sameSurfaceMm(toleranceFor(objectOf(poses_[i]), noise_mm_));
    int all = 0;
    int free = 0;
    forEachTexel(views[i], [&](int x, int y, const SurfaceTexel& texel) {
      const double own_mm = static_cast<double>(texel.w);
      const double slant = std::max(kLeastSlant, static_cast<double>(std::abs(texel.z)));
      const double above_mm = own_mm - same_mm / slant;
      const double measured_mm = static_cast<double>(measured_px.at(x, y)) * ortho.pixel_mm;
      const bool by_data = measured_mm > 0.0 && measured_mm < above_mm;
      const bool by_part = nearest.part.at(x, y) != static_cast<int>(i) &&
                           static_cast<double>(nearest.depth_mm.at(x, y)) < above_mm;
      ++all;
      free += by_data || by_part ? 0 : 1;
    });
    shares.push_back(all > 0 ? static_cast<double>(free) / all : 0.0);
  }
  return shares;
}

}  // namespace rangepose
