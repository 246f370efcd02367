#include "sim/scanner.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace rangepose {
namespace {

/// The table as if nothing lay on it; 0 where a ray passes it by.
SurfaceTexel tableAt(const Camera& camera, const Pose& camera_from_world, int u, int v) {
  const glm::dvec3 up = camera_from_world.rotation[2];
  const double along_ray = glm::dot(up, camera.unproject(u, v, 1.0));
  const double z = glm::dot(up, camera_from_world.translation_mm) / along_ray;
  if (!(along_ray < 0.0) || !(z > 0.0)) return SurfaceTexel(0.0f);
  return SurfaceTexel(glm::vec3(up), static_cast<float>(z));
}

/// The same camera with more image on all sides.
Camera padded(const Camera& camera, int margin_px) {
  Camera wide = camera;
  wide.width += 2 * margin_px;
  wide.height += 2 * margin_px;
  wide.cx += margin_px;
  wide.cy += margin_px;
  return wide;
}

void renderPart(const Mesh& mesh, int index, const Pose& camera_from_object, CleanView& view) {
  const Sphere sphere = boundingSphere(mesh);
  const int all = std::max(view.camera.width, view.camera.height);
  const SurfaceWindow window =
      windowAround(view.camera, camera_from_object * sphere.center_mm, sphere.radius_mm, all);
  const Image<SurfaceTexel> seen =
      host::renderSurface(mesh, view.camera, camera_from_object, window);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const SurfaceTexel& texel = seen.at(x, y);
      if (texel.w == 0.0f || !view.surface.contains(window.x0 + x, window.y0 + y)) continue;
      ++view.silhouette_px[static_cast<std::size_t>(index)];
      SurfaceTexel& nearest = view.surface.at(window.x0 + x, window.y0 + y);
      if (nearest.w != 0.0f && nearest.w <= texel.w) continue;
      nearest = texel;
      view.part.at(window.x0 + x, window.y0 + y) = static_cast<std::int16_t>(index);
    }
  }
}

template <typename T>
Image<T> cropped(const Image<T>& image, int margin_px) {
  Image<T> result(image.width() - 2 * margin_px, image.height() - 2 * margin_px);
  for (int y = 0; y < result.height(); ++y) {
    std::copy_n(image.row(y + margin_px) + margin_px, result.width(), result.row(y));
  }
  return result;
}

std::vector<PartTruth> truthOf(const std::vector<PlacedPart>& heap,
                               const Pose& camera_from_world,
                               const CleanView& wide,
                               const Image<std::int16_t>& seen) {
  std::vector<int> visible_px(heap.size(), 0);
  for (const std::int16_t index : seen) {
    if (index >= 0) ++visible_px[static_cast<std::size_t>(index)];
  }
  std::vector<PartTruth> truth;
  for (std::size_t k = 0; k < heap.size(); ++k) {
    const int all = wide.silhouette_px[k];
    truth.push_back({heap[k].mesh,
                     camera_from_world * heap[k].world_from_object,
                     all == 0 ? 0.0 : static_cast<double>(visible_px[k]) / all});
  }
  return truth;
}

void checkDistance(const std::vector<Mesh>& meshes,
                   const std::vector<PlacedPart>& heap,
                   const Pose& camera_from_world) {
  for (const PlacedPart& part : heap) {
    const Sphere sphere = boundingSphere(meshes.at(static_cast<std::size_t>(part.mesh)));
    const glm::dvec3 center = camera_from_world * (part.world_from_object * sphere.center_mm);
    if (center.z - sphere.radius_mm <= 1.0) {
      throw Error(
          "scanner: the camera lies within the heap; give a larger distance or check the unit of "
          "the meshes");
    }
  }
}

}  // namespace

void ScannerOptions::check() const {
  RP_CHECK(width >= 8 && height >= 8 && width <= 8192 && height <= 8192,
           "scanner: image size " + std::to_string(width) + "x" + std::to_string(height) +
               ", must be 8 to 8192 each");
  RP_CHECK(focal_px >= 0.0, "scanner: focal_px must not be negative");
  RP_CHECK(distance_mm > 0.0, "scanner: distance_mm must be positive");
  RP_CHECK(tilt_rad >= 0.0 && tilt_rad < 1.0, "scanner: tilt_rad must be 0 to 1");
  RP_CHECK(depth_scale > 0.0, "scanner: depth_scale must be positive");
  RP_CHECK(noise >= 0 && noise <= 2,
           "scanner: noise is " + std::to_string(noise) + ", must be 0, 1 or 2");
}

Camera scannerCamera(const ScannerOptions& options) {
  options.check();
  Camera camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.fx = options.focal_px > 0.0 ? options.focal_px : 570.0 * options.width / 640.0;
  camera.fy = camera.fx;
  camera.cx = 0.5 * (options.width - 1);
  camera.cy = 0.5 * (options.height - 1);
  camera.depth_scale = options.depth_scale;
  return camera;
}

Pose scannerPose(const std::vector<PlacedPart>& heap, const ScannerOptions& options) {
  options.check();
  RP_CHECK(!heap.empty(), "scanner: the heap is empty");
  glm::dvec3 middle(0.0);
  for (const PlacedPart& part : heap) middle += part.world_from_object.translation_mm;
  middle /= static_cast<double>(heap.size());
  const double c = std::cos(options.tilt_rad);
  const double s = std::sin(options.tilt_rad);
  const glm::dmat3 world_from_camera(
      glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -c, -s), glm::dvec3(0.0, s, -c));
  const glm::dvec3 eye = middle - options.distance_mm * world_from_camera[2];
  return Pose{world_from_camera, eye}.inverse();
}

CleanView renderHeap(const std::vector<Mesh>& meshes,
                     const std::vector<PlacedPart>& heap,
                     const Camera& camera,
                     const Pose& camera_from_world) {
  CleanView view;
  view.camera = camera;
  view.surface = Image<SurfaceTexel>(camera.width, camera.height);
  view.part = Image<std::int16_t>(camera.width, camera.height, std::int16_t{-1});
  view.silhouette_px.assign(heap.size(), 0);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      view.surface.at(u, v) = tableAt(camera, camera_from_world, u, v);
    }
  }
  for (std::size_t k = 0; k < heap.size(); ++k) {
    const Mesh& mesh = meshes.at(static_cast<std::size_t>(heap[k].mesh));
    renderPart(mesh, static_cast<int>(k), camera_from_world * heap[k].world_from_object, view);
  }
  return view;
}

Scan scanHeap(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const ScannerOptions& options) {
  return scanFrom(meshes, heap, scannerPose(heap, options), options);
}

Scan scanFrom(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const Pose& camera_from_world,
              const ScannerOptions& options) {
  const Camera camera = scannerCamera(options);
  checkDistance(meshes, heap, camera_from_world);
  // Beyond the border, so that a part that it cuts counts as partly hidden.
  const int margin_px = camera.width / 2;
  const CleanView wide = renderHeap(meshes, heap, padded(camera, margin_px), camera_from_world);
  const Image<SurfaceTexel> seen = cropped(wide.surface, margin_px);
  Scan scan;
  scan.image.camera = camera;
  scan.truth = truthOf(heap, camera_from_world, wide, cropped(wide.part, margin_px));
  if (options.noise == 0) {
    scan.image.depth_mm = depthOf(seen);
    return scan;
  }
  const SensorNoise noise = sensorNoise(options.noise);
  const Pose projector_from_camera{glm::dmat3(1.0), {-noise.baseline_mm, 0.0, 0.0}};
  const CleanView lit = renderHeap(
      meshes, heap, padded(camera, margin_px), projector_from_camera * camera_from_world);
  const ProjectorView projector{lit.camera, depthOf(lit.surface), noise.baseline_mm};
  Random random(options.seed);
  scan.image.depth_mm = sensed(seen, camera, projector, noise, random);
  return scan;
}

}  // namespace rangepose
