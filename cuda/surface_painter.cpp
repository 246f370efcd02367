#include "cuda/surface_painter.h"

#include <algorithm>
#include <memory>
#include <unordered_map>

#include "core/parallel.h"
#include "gles/framebuffer.h"
#include "gles/surface_gles.h"

namespace rangepose::cuda {
namespace {

constexpr int kChannels = 4;

int roundedUp(int value, int step) { return (value + step - 1) / step * step; }

std::size_t texelsOf(const DeviceImage& image) {
  return static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

}  // namespace

PixelBox TileGrid::box(std::size_t index, const SurfaceWindow& window) const {
  const int x = static_cast<int>(index) % columns * tile;
  const int y = static_cast<int>(index) / columns * tile;
  return {x, y, x + window.width, y + window.height};
}

TileGrid tileGrid(const std::vector<RenderTask>& tasks) {
  constexpr int kTileStep = 16;
  constexpr int kColumns = 8;
  constexpr int kRowStep = 2;
  int largest = 1;
  for (const RenderTask& task : tasks)
    largest = std::max({largest, task.window.width, task.window.height});
  const int count = static_cast<int>(tasks.size());
  return {roundedUp(largest, kTileStep),
          kColumns,
          roundedUp(std::max(1, (count + kColumns - 1) / kColumns), kRowStep)};
}

SurfacePainter::SurfacePainter(Workspace& workspace, gles::Context* context)
    : workspace_(workspace) {
  if (context != nullptr) device_.emplace(*context);
}

void SurfacePainter::resize(const TileGrid& grid) {
  const int width = grid.tile * grid.columns;
  const int height = grid.tile * grid.rows;
  if (image_ && image_->width() >= width && image_->height() >= height) return;
  const int new_width = std::max(width, image_ ? image_->width() : 0);
  const int new_height = std::max(height, image_ ? image_->height() : 0);
  // What is queued may still read the old one.
  workspace_.synchronize();
  image_.reset();
  image_.emplace(workspace_.memory(), Element::kFloat4, new_width, new_height);
  if (!device_) return;
  depth_.emplace(gles::Format::kDepth32f, new_width, new_height);
  if (image_->shared() == nullptr) {
    color_.emplace(gles::Format::kRgba32f, new_width, new_height);
  }
}

void SurfacePainter::drawWithGl(const std::vector<RenderTask>& tasks,
                                const Camera& camera,
                                const TileGrid& grid,
                                const gles::Texture& color) {
  const gles::Framebuffer target(color, &*depth_);
  target.clear(glm::vec4(0.0f));
  target.clearDepth();
  std::unordered_map<const Mesh*, std::shared_ptr<const gles::MeshBuffers>> buffers;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const RenderTask& task = tasks[i];
    if (task.window.width <= 0 || task.window.height <= 0) continue;
    std::shared_ptr<const gles::MeshBuffers>& mesh = buffers[task.mesh];
    if (mesh == nullptr) mesh = meshes_.of(*task.mesh);
    gles::renderSurface(*device_,
                        target,
                        grid.box(i, task.window),
                        *task.mesh,
                        *mesh,
                        camera,
                        task.camera_from_object,
                        task.window);
  }
}

void SurfacePainter::drawOnHost(const std::vector<RenderTask>& tasks,
                                const Camera& camera,
                                const TileGrid& grid) {
  const auto width = static_cast<std::size_t>(image_->width());
  parallelFor(static_cast<int>(tasks.size()), 1, [&](int begin, int end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const RenderTask& task = tasks[i];
      const Image<SurfaceTexel> surface =
          host::renderSurface(*task.mesh, camera, task.camera_from_object, task.window);
      const PixelBox box = grid.box(i, task.window);
      for (int y = 0; y < surface.height(); ++y) {
        const std::size_t at =
            static_cast<std::size_t>(box.y0 + y) * width + static_cast<std::size_t>(box.x0);
        const float* row = &surface.row(y)->x;
        std::copy(row, row + kChannels * surface.width(), staging_.data() + kChannels * at);
      }
    }
  });
}

const DeviceImage& SurfacePainter::paint(const std::vector<RenderTask>& tasks,
                                         const Camera& camera,
                                         const TileGrid& grid) {
  const cudaStream_t stream = workspace_.begin();
  resize(grid);
  if (image_->shared() != nullptr) {
    drawWithGl(tasks, camera, grid, image_->shared()->texture());
    return *image_;
  }
  // What the last call copied from here must have left.
  workspace_.synchronize();
  staging_.reserve(kChannels * texelsOf(*image_));
  if (device_) {
    drawWithGl(tasks, camera, grid, *color_);
    color_->downloadRgba(0, image_->height(), staging_.data());
  } else {
    drawOnHost(tasks, camera, grid);
  }
  Frame({&*image_}, stream).upload(*image_, staging_.data());
  return *image_;
}

}  // namespace rangepose::cuda
