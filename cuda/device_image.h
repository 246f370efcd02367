// Images that CUDA works on, wherever their memory comes from.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cuda/array.h"
#include "cuda/shared_texture.h"

namespace rangepose::cuda {

/// A GL texture that CUDA shares, or memory of CUDA alone.
class DeviceImage {
 public:
  enum class Memory { kShared, kOwn };

  /// Content undefined. For kShared as SharedTexture.
  DeviceImage(Memory memory, Element element, int width, int height);

  Element element() const { return element_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Null for kOwn.
  const SharedTexture* shared() const { return shared_ ? &*shared_ : nullptr; }

 private:
  friend class Frame;
  Element element_;
  int width_;
  int height_;
  std::optional<SharedTexture> shared_;
  std::optional<Array> own_;
};

/// While it lives CUDA works on a list of images: those that are shared are mapped, all at once.
class Frame {
 public:
  /// The images must outlive it; one may be named more than once.
  Frame(const std::vector<const DeviceImage*>& images, cudaStream_t stream);

  /// Throws Error for an image that is not in the list.
  ImageView view(const DeviceImage& image) const;
  /// width * height elements, row by row. Returns once pageable memory may be changed again.
  void upload(const DeviceImage& image, const void* from) const;
  /// Does not wait: `into` is there once the stream has come past it.
  void download(const DeviceImage& image, void* into) const;

 private:
  struct Entry {
    const DeviceImage* image;
    cudaArray_t array;
    ImageView view;
  };
  const Entry& entry(const DeviceImage& image) const;

  std::vector<Entry> entries_;
  MappedTextures mapped_;
  cudaStream_t stream_;
};

/// Images that come and go with each frame are kept, so that nothing is allocated or registered
/// but in the first; those that were free for longest go when there are too many. All of them go
/// with the pool: whoever lets it go knows which GL context they are of.
class ImagePool {
 public:
  explicit ImagePool(DeviceImage::Memory memory) : memory_(memory) {}

  /// Goes back to the pool by itself. The pool may be gone by then, but the image is too. Content
  /// undefined.
  using Lease = std::shared_ptr<DeviceImage>;
  Lease take(Element element, int width, int height);

 private:
  struct Images {
    std::vector<std::unique_ptr<DeviceImage>> all;
    std::vector<DeviceImage*> free;
  };
  void makeRoom();

  DeviceImage::Memory memory_;
  std::shared_ptr<Images> images_ = std::make_shared<Images>();
};

}  // namespace rangepose::cuda
