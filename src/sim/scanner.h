// A virtual depth camera above a heap on a table or in a bin: what it sees, and the truth about it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "sim/bin_shape.h"
#include "sim/clean_view.h"
#include "sim/heap.h"
#include "sim/sensor_model.h"
#include "stages/surface.h"

namespace rangepose {

struct ScannerOptions {
  SensorModel sensor = sensorModel("structured-light");
  int width = 0;                   ///< [px], 0: that of the sensor
  int height = 0;                  ///< [px], 0: that of the sensor
  double focal_px = 0.0;           ///< 0: that of the sensor, in proportion to the image's width
  double distance_mm = 650.0;      ///< from the camera to the middle of the heap
  bool orthographic = false;       ///< parallel rays; no projector, and so no shadow of its light
  double pixel_size_mm = 0.0;      ///< orthographic; 0: that of a pinhole camera at this distance
  double tilt_rad = 0.2617993878;  ///< of the view from straight down, below 1 (57 degrees)
  double depth_scale = 0.0;        ///< step of the stored depth [mm], 0: that of the sensor
  std::uint64_t seed = 1;          ///< of the noise; same seed, same image
  void check() const;              ///< throws Error naming the bad field
};

struct PartTruth {
  int mesh = 0;  ///< index into the meshes
  Pose camera_from_object;
  /// Pixels seen of those that the part would cover if it were alone and no image border cut it;
  /// 0..1.
  double visible_fraction = 0.0;
  int all_px = 0;        ///< pixels that the part would cover then
  int measured_px = 0;   ///< of those within the image: with a depth, be it of another part
  int visible_px = 0;    ///< pixels of the image that show the part, noise aside
  PixelBox all_box;      ///< around all_px, may reach beyond the image
  PixelBox visible_box;  ///< around visible_px
};

struct Scan {
  DepthImage image;
  std::vector<PartTruth> truth;  ///< in the order of the heap
  Pose camera_from_world;
};

/// Camera and its pose for a heap: over it, tilted about the world's x axis, looking at the heap's
/// middle.
Camera scannerCamera(const ScannerOptions& options);
Pose scannerPose(const std::vector<PlacedPart>& heap, const ScannerOptions& options);

/// Takes a depth image. Depth is rounded to depth_scale unless the sensor is "none".
Scan scanHeap(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const ScannerOptions& options);

/// The same from a camera placed at will; the tilt of the options is not used, and the distance
/// only for the pixel size of an orthographic camera. `shiny` as for renderHeap().
Scan scanFrom(const std::vector<Mesh>& meshes,
              const std::vector<PlacedPart>& heap,
              const Pose& camera_from_world,
              const ScannerOptions& options,
              const Surroundings& surroundings = {},
              const std::vector<Mesh>& shiny = {});

/// A bin that stands on a table, and what lies in it.
Surroundings surroundingsOf(const BinShape& bin);

/// The distance from the middle of the bin at which all of it is in the image, and not nearer than
/// the sensor measures [mm].
double distanceFor(const BinShape& bin, const ScannerOptions& options);

/// Over the middle of the bin, `distance_mm` of the options away, 0: distanceFor().
Scan scanBin(const std::vector<Mesh>& meshes,
             const std::vector<PlacedPart>& parts,
             const BinShape& bin,
             const ScannerOptions& options,
             const std::vector<Mesh>& shiny = {});

}  // namespace rangepose
