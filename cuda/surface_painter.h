// Rendered surfaces of many posed objects in one image that CUDA reads.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cuda/buffer.h"
#include "cuda/device_image.h"
#include "cuda/scene_cuda.h"
#include "gles/device.h"
#include "gles/mesh_buffers.h"
#include "stages/stage_set.h"

namespace rangepose::cuda {

/// Where the surface of each task lies in the image: tiles in rows.
struct TileGrid {
  int tile = 0;     ///< width and height of a tile [px]
  int columns = 0;  ///< tiles in a row
  int rows = 0;
  PixelBox box(std::size_t index, const SurfaceWindow& window) const;
};

/// For the largest window of the tasks; sizes grow in steps, so that an image serves many calls.
TileGrid tileGrid(const std::vector<RenderTask>& tasks);

/// GL draws into a texture that CUDA shares; or into one of its own that is copied through pinned
/// memory; or, without a context, the host draws.
class SurfacePainter {
 public:
  /// Both must outlive it.
  SurfacePainter(Workspace& workspace, gles::Context* context);

  /// The image is good until the next call.
  const DeviceImage& paint(const std::vector<RenderTask>& tasks,
                           const Camera& camera,
                           const TileGrid& grid);
  std::int64_t draws() const { return device_ ? device_->draws() : 0; }

 private:
  void resize(const TileGrid& grid);
  void drawWithGl(const std::vector<RenderTask>& tasks,
                  const Camera& camera,
                  const TileGrid& grid,
                  const gles::Texture& color);
  void drawOnHost(const std::vector<RenderTask>& tasks, const Camera& camera, const TileGrid& grid);

  Workspace& workspace_;
  std::optional<gles::Device> device_;
  gles::ResidentMeshes meshes_;
  std::optional<DeviceImage> image_;
  std::optional<gles::Texture> depth_;
  std::optional<gles::Texture> color_;  ///< where the image is not shared
  PinnedBuffer<float> staging_;
};

}  // namespace rangepose::cuda
