// A virtual depth camera above a heap on a table: what it sees, and the truth about it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "sim/heap.h"
#include "sim/sensor_noise.h"
#include "stages/surface.h"

namespace rangepose {

struct ScannerOptions {
  int width = 640;                 ///< [px]
  int height = 480;                ///< [px]
  double focal_px = 0.0;           ///< 0: 570 for an image 640 wide, in proportion for others
  double distance_mm = 650.0;      ///< from the camera to the middle of the heap
  double tilt_rad = 0.2617993878;  ///< of the view from straight down, below 1 (57 degrees)
  double depth_scale = 0.1;        ///< step of the stored depth [mm]
  int noise = 1;           ///< 0 none, 1 structured light, 2 a rough sensor (sensor_noise.h)
  std::uint64_t seed = 1;  ///< of the noise; same seed, same image
  void check() const;      ///< throws Error naming the bad field
};

/// What is seen at each pixel, without noise.
struct CleanView {
  Camera camera;
  Image<SurfaceTexel> surface;     ///< nearest of all parts and the table
  Image<std::int16_t> part;        ///< index into the heap, -1 the table or nothing
  std::vector<int> silhouette_px;  ///< by part: pixels it would cover if it were alone
};

/// Renders the heap and its table (z = 0). Silhouettes are counted within the camera's image.
CleanView renderHeap(const std::vector<Mesh>& meshes,
                     const std::vector<PlacedPart>& heap,
                     const Camera& camera,
                     const Pose& camera_from_world);

struct PartTruth {
  int mesh = 0;  ///< index into the meshes
  Pose camera_from_object;
  /// Pixels seen of those that the part would cover if it were alone and no image border cut it;
  /// 0..1.
  double visible_fraction = 0.0;
};

struct Scan {
  DepthImage image;
  std::vector<PartTruth> truth;  ///< in the order of the heap
};

/// Camera and its pose for a heap: over it, tilted about the world's x axis, looking at the heap's
/// middle.
Camera scannerCamera(const ScannerOptions& options);
Pose scannerPose(const std::vector<PlacedPart>& heap, const ScannerOptions& options);

/// Takes a depth image. Depth is rounded to depth_scale unless noise is 0.
Scan scanHeap(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const ScannerOptions& options);

/// The same from a camera placed at will; distance and tilt of the options are not used.
Scan scanFrom(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const Pose& camera_from_world,
              const ScannerOptions& options);

}  // namespace rangepose
