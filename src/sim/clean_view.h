// What a perfect camera sees of a heap and of what it lies in.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "sim/heap.h"
#include "stages/surface.h"

namespace rangepose {

/// What a part would cover if it were alone.
struct Silhouette {
  SurfaceWindow window;         ///< within the image
  Image<std::uint8_t> covered;  ///< of the window: 1 where the part is
  PixelBox box;                 ///< around the covered pixels, in pixels of the image
};

/// What is seen at each pixel, without noise.
struct CleanView {
  Camera camera;
  Image<SurfaceTexel> surface;          ///< nearest of all parts, bin and table
  Image<std::int16_t> part;             ///< index into the heap; -1 bin, table or nothing
  Image<std::uint8_t> shiny;            ///< 1 where a face is seen that sends no light back
  std::vector<int> silhouette_px;       ///< by part: pixels it would cover if it were alone
  std::vector<Silhouette> silhouettes;  ///< likewise
};

/// What is there beside the parts: a table, and a fixed object such as a bin on it.
struct Surroundings {
  double table_z_mm = 0.0;  ///< height of the table, which has no end
  Mesh fixed;               ///< world frame; no triangles: none
};

/// The same camera with margin_px more image on all sides.
Camera padded(const Camera& camera, int margin_px);

/// Silhouettes are counted within the camera's image. `shiny` has the faces of each mesh that send
/// no light back to a sensor, or nothing for any mesh.
CleanView renderHeap(const std::vector<Mesh>& meshes,
                     const std::vector<PlacedPart>& heap,
                     const Camera& camera,
                     const Pose& camera_from_world,
                     const Surroundings& surroundings = {},
                     const std::vector<Mesh>& shiny = {});

}  // namespace rangepose
