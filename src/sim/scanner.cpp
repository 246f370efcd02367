#include "sim/scanner.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "sim/sensing.h"

namespace rangepose {
namespace {

template <typename T>
Image<T> cropped(const Image<T>& image, int margin_px) {
  Image<T> result(image.width() - 2 * margin_px, image.height() - 2 * margin_px);
  for (int y = 0; y < result.height(); ++y) {
    std::copy_n(image.row(y + margin_px) + margin_px, result.width(), result.row(y));
  }
  return result;
}

/// The image of a view that reaches margin_px beyond it on all sides.
CleanView cropped(const CleanView& wide, const Camera& camera, int margin_px) {
  CleanView view;
  view.camera = camera;
  view.surface = cropped(wide.surface, margin_px);
  view.part = cropped(wide.part, margin_px);
  view.silhouette_px = wide.silhouette_px;
  return view;
}

void grow(PixelBox& box, int u, int v) {
  if (box.empty()) {
    box = {u, v, u + 1, v + 1};
    return;
  }
  box = {
      std::min(box.x0, u), std::min(box.y0, v), std::max(box.x1, u + 1), std::max(box.y1, v + 1)};
}

/// Pixels of a silhouette of the wide view that lie in the image and have a depth there.
int measuredPixels(const Silhouette& silhouette, const Image<float>& depth_mm, int margin_px) {
  int count = 0;
  for (int y = 0; y < silhouette.covered.height(); ++y) {
    for (int x = 0; x < silhouette.covered.width(); ++x) {
      const int u = silhouette.window.x0 + x - margin_px;
      const int v = silhouette.window.y0 + y - margin_px;
      if (silhouette.covered.at(x, y) == 0 || !depth_mm.contains(u, v)) continue;
      count += depth_mm.at(u, v) > 0.0f ? 1 : 0;
    }
  }
  return count;
}

/// `wide` reaches margin_px beyond the image on all sides.
std::vector<PartTruth> truthOf(const std::vector<PlacedPart>& heap,
                               const Pose& camera_from_world,
                               const CleanView& wide,
                               int margin_px,
                               const Image<float>& depth_mm) {
  std::vector<PartTruth> truth;
  for (std::size_t k = 0; k < heap.size(); ++k) {
    PartTruth part;
    part.mesh = heap[k].mesh;
    part.camera_from_object = camera_from_world * heap[k].world_from_object;
    part.all_px = wide.silhouette_px[k];
    part.measured_px = measuredPixels(wide.silhouettes[k], depth_mm, margin_px);
    const PixelBox& box = wide.silhouettes[k].box;
    if (!box.empty()) {
      part.all_box = {
          box.x0 - margin_px, box.y0 - margin_px, box.x1 - margin_px, box.y1 - margin_px};
    }
    truth.push_back(part);
  }
  for (int v = 0; v < depth_mm.height(); ++v) {
    for (int u = 0; u < depth_mm.width(); ++u) {
      const int index = wide.part.at(u + margin_px, v + margin_px);
      if (index < 0) continue;
      ++truth[static_cast<std::size_t>(index)].visible_px;
      grow(truth[static_cast<std::size_t>(index)].visible_box, u, v);
    }
  }
  for (PartTruth& part : truth) {
    if (part.all_px > 0) {
      part.visible_fraction = static_cast<double>(part.visible_px) / part.all_px;
    }
  }
  return truth;
}

/// Tilted about the world's x axis, looking at a point from the distance of the options.
Pose poseOver(const glm::dvec3& middle, const ScannerOptions& options) {
  const double c = std::cos(options.tilt_rad);
  const double s = std::sin(options.tilt_rad);
  const glm::dmat3 world_from_camera(
      glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -c, -s), glm::dvec3(0.0, s, -c));
  const glm::dvec3 eye = middle - options.distance_mm * world_from_camera[2];
  return Pose{world_from_camera, eye}.inverse();
}

glm::dvec3 middleOf(const BinShape& bin) { return {0.0, 0.0, 0.5 * bin.inner_mm.z}; }

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
  const auto isSize = [](int size) { return size == 0 || (size >= 8 && size <= 8192); };
  RP_CHECK(isSize(width) && isSize(height),
           "scanner: image size " + std::to_string(width) + "x" + std::to_string(height) +
               ", must be 8 to 8192 each, or 0 for that of the sensor");
  RP_CHECK(focal_px >= 0.0, "scanner: focal_px must not be negative");
  RP_CHECK(distance_mm >= 0.0, "scanner: distance_mm must not be negative");
  RP_CHECK(pixel_size_mm >= 0.0, "scanner: pixel_size_mm must not be negative");
  RP_CHECK(tilt_rad >= 0.0 && tilt_rad < 1.0, "scanner: tilt_rad must be 0 to 1");
  RP_CHECK(depth_scale >= 0.0, "scanner: depth_scale must not be negative");
}

Camera scannerCamera(const ScannerOptions& options) {
  options.check();
  const SensorModel& sensor = options.sensor;
  Camera camera;
  camera.width = options.width > 0 ? options.width : sensor.width;
  camera.height = options.height > 0 ? options.height : sensor.height;
  camera.fx = options.focal_px > 0.0 ? options.focal_px : sensor.fx * camera.width / sensor.width;
  camera.fy = camera.fx * sensor.fy / sensor.fx;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  camera.depth_scale = options.depth_scale > 0.0 ? options.depth_scale : sensor.depth_scale;
  camera.orthographic = options.orthographic;
  if (options.orthographic) {
    camera.pixel_size_mm =
        options.pixel_size_mm > 0.0 ? options.pixel_size_mm : options.distance_mm / camera.fx;
    RP_CHECK(camera.pixel_size_mm > 0.0, "scanner: pixel_size_mm or distance_mm must be positive");
  }
  return camera;
}

Pose scannerPose(const std::vector<PlacedPart>& heap, const ScannerOptions& options) {
  options.check();
  RP_CHECK(!heap.empty(), "scanner: the heap is empty");
  RP_CHECK(options.distance_mm > 0.0, "scanner: distance_mm must be positive");
  glm::dvec3 middle(0.0);
  for (const PlacedPart& part : heap) middle += part.world_from_object.translation_mm;
  middle /= static_cast<double>(heap.size());
  return poseOver(middle, options);
}

Scan scanHeap(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const ScannerOptions& options) {
  return scanFrom(meshes, heap, scannerPose(heap, options), options);
}

Scan scanFrom(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const Pose& camera_from_world,
              const ScannerOptions& options,
              const Surroundings& surroundings) {
  const Camera camera = scannerCamera(options);
  checkDistance(meshes, heap, camera_from_world);
  // Beyond the border, so that a part that it cuts counts as partly hidden.
  const int margin_px = camera.width / 2;
  const Camera wide_camera = padded(camera, margin_px);
  const CleanView wide = renderHeap(meshes, heap, wide_camera, camera_from_world, surroundings);
  const RenderFrom render = [&](const Camera& from, const glm::dvec3& position_mm) {
    const Pose there_from_camera{glm::dmat3(1.0), -position_mm};
    return renderHeap(meshes, heap, from, there_from_camera * camera_from_world, surroundings);
  };
  Scan scan;
  scan.camera_from_world = camera_from_world;
  scan.image.camera = camera;
  scan.image.depth_mm =
      sense(cropped(wide, camera, margin_px), render, options.sensor, options.seed);
  scan.truth = truthOf(heap, camera_from_world, wide, margin_px, scan.image.depth_mm);
  return scan;
}

Surroundings surroundingsOf(const BinShape& bin) { return {-binThickness(bin), binMesh(bin)}; }

double distanceFor(const BinShape& bin, const ScannerOptions& options) {
  constexpr double kShare = 0.96;  // of the image, for the bin with its walls
  ScannerOptions from = options;
  from.distance_mm = 1.0;
  const Camera camera = scannerCamera(from);
  const Mesh mesh = binMesh(bin);
  const glm::dvec2 half_px = 0.5 * kShare * glm::dvec2(camera.width, camera.height);
  double distance_mm = 0.0;
  for (const glm::vec3& vertex : mesh.vertices) {
    const glm::dvec3 p = poseOver(middleOf(bin), from) * glm::dvec3(vertex);
    const double needed =
        camera.fx * std::max(std::abs(p.x) / half_px.x, std::abs(p.y) / half_px.y);
    const double nearer = camera.orthographic ? 0.0 : from.distance_mm - p.z;
    distance_mm = std::max(distance_mm, needed + nearer);
  }
  return std::ceil(std::max(distance_mm, options.sensor.nearest_mm));
}

Scan scanBin(const std::vector<Mesh>& meshes,
             const std::vector<PlacedPart>& parts,
             const BinShape& bin,
             const ScannerOptions& options) {
  ScannerOptions from = options;
  if (from.distance_mm == 0.0) from.distance_mm = distanceFor(bin, options);
  return scanFrom(meshes, parts, poseOver(middleOf(bin), from), from, surroundingsOf(bin));
}

}  // namespace rangepose
