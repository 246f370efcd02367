// Scene images on the CUDA path: made of a depth image, kept on the device, copied back.
#pragma once

#include <memory>
#include <vector>

#include "cuda/buffer.h"
#include "cuda/channels.h"
#include "cuda/device_image.h"
#include "cuda/stream.h"
#include "gles/context.h"
#include "stages/stage_set.h"

namespace rangepose::cuda {

/// What all stages of a path share. Everything is put into one stream.
class Workspace {
 public:
  /// `context` may be null for images of CUDA's own.
  Workspace(gles::Context* context, DeviceImage::Memory memory);
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
  DeviceImage::Memory memory() const { return memory_; }
  void synchronize() const { stream_.synchronize(); }

  Buffer<unsigned int> splats;  ///< for resample
  Buffer<std::int32_t> labels;  ///< for patches

 private:
  gles::Context* context_;
  DeviceImage::Memory memory_;
  Stream stream_;
  ImagePool images_;
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
  /// `image` must outlive it.
  CudaDepth(const DepthImage& image, const Image<std::uint8_t>& keep, cudaStream_t stream);

  const Camera& camera() const { return camera_; }
  DepthPixels pixels() const;
  /// The measured depth without what is not kept [mm], row by row.
  const float* foreground() const { return foreground_.data(); }

 private:
  Camera camera_;
  Buffer<float> depth_;
  Buffer<float> foreground_;
  Buffer<std::uint8_t> keep_;
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
