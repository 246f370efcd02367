// Scene images on the CUDA path: made of a depth image, kept on the device, copied back.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "cuda/buffer.h"
#include "cuda/channels.h"
#include "cuda/device_image.h"
#include "cuda/stream.h"
#include "gles/context.h"
#include "stages/stage_set.h"

namespace rangepose::cuda {

/// Memory of a depth image.
struct DepthBuffers {
  Buffer<float> depth;
  Buffer<float> foreground;
  Buffer<std::uint8_t> keep;
};

/// What all stages of a path share. Everything is put into one stream.
class Workspace {
 public:
  /// `context` may be null for images of CUDA's own.
  Workspace(gles::Context* context, DeviceImage::Memory memory);
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace();

  /// The stream, with the context current on this thread.
  cudaStream_t begin();
  /// Content undefined; goes back by itself.
  ImagePool::Lease take(Element element, int width, int height) {
    return images_.take(element, width, height);
  }
  ImagePool::Lease take(const Image<float>& like) {
    return take(Element::kFloat, like.width(), like.height());
  }
  /// Goes back by itself; large enough for `pixels`.
  std::shared_ptr<DepthBuffers> takeDepth(std::size_t pixels);
  DeviceImage::Memory memory() const { return memory_; }
  void synchronize() const { stream_.synchronize(); }

  Buffer<unsigned int> splats;  ///< for resample
  Buffer<std::int32_t> labels;  ///< for patches

 private:
  gles::Context* context_;
  DeviceImage::Memory memory_;
  Stream stream_;
  ImagePool images_;
  std::shared_ptr<std::vector<std::unique_ptr<DepthBuffers>>> depths_;  ///< that are free
};

class CudaScene : public ResidentScene {
 public:
  /// Content undefined; `workspace` must outlive it.
  CudaScene(Workspace& workspace, const OrthoCamera& camera);

  const OrthoCamera& camera() const override { return camera_; }
  SceneChannels download() const override;
  const DeviceImage& range() const { return *range_; }
  const DeviceImage& edges() const { return *edges_; }
  const DeviceImage& distance() const { return *distance_; }

 private:
  Workspace& workspace_;
  OrthoCamera camera_;
  ImagePool::Lease range_;
  ImagePool::Lease edges_;
  ImagePool::Lease distance_;
};

/// A depth image and its mask on the device.
class CudaDepth : public ResidentDepth {
 public:
  CudaDepth(const DepthImage& image, const Image<std::uint8_t>& keep, Workspace& workspace);
  /// Of buffers that are filled already, all three.
  CudaDepth(const Camera& camera, std::shared_ptr<DepthBuffers> buffers)
      : camera_(camera), masked_(true), buffers_(std::move(buffers)) {}

  const Camera& camera() const { return camera_; }
  DepthPixels pixels() const;
  /// The measured depth without what is not kept [mm], row by row.
  const float* foreground() const { return buffers_->foreground.data(); }

 private:
  Camera camera_;
  bool masked_;
  std::shared_ptr<DepthBuffers> buffers_;
};

/// Resample to distance in one chain.
std::unique_ptr<CudaScene> prepareScene(Workspace& workspace,
                                        const CudaDepth& depth,
                                        const OrthoCamera& camera,
                                        const PixelBox& region,
                                        const ChannelOptions& options);

std::unique_ptr<CudaScene> uploadScene(Workspace& workspace, const SceneChannels& channels);

Image<std::int32_t> patchesOf(Workspace& workspace, const CudaScene& scene);

// One stage at a time, from and to host memory.
Image<float> resampled(Workspace& workspace, const CudaDepth& depth, const OrthoCamera& camera);
Image<float> medianOf(Workspace& workspace, const Image<float>& range);
Image<float> edgesOf(Workspace& workspace, const Image<float>& range_px, float threshold_px);
Image<EdtTexel> distanceTexelsOf(Workspace& workspace,
                                 const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes);
Image<float> distanceOf(Workspace& workspace,
                        const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes);
Image<std::int32_t> patchesOf(Workspace& workspace,
                              const Image<float>& range_px,
                              const Image<float>& edges);

}  // namespace rangepose::cuda
