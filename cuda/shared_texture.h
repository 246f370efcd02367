// GL textures that CUDA works on without a copy. The order of things is held by the types: a
// texture is deleted after it is unregistered, and that after it is unmapped, whoever goes first.
#pragma once

#include <memory>
#include <vector>

#include "cuda/array.h"
#include "gles/texture.h"

namespace rangepose::cuda {

/// A GL texture that is registered with CUDA for as long as it lives. The GL context that it was
/// made with must outlive it and be current on the calling thread wherever it is made, mapped,
/// unmapped or let go.
class SharedTexture {
 public:
  /// Content undefined. Throws Error where the driver does not share textures of this context.
  SharedTexture(Element element, int width, int height);

  /// For GL. Throws Error while it is mapped: it belongs to CUDA then.
  const gles::Texture& texture() const;
  Element element() const;

 private:
  friend class MappedTextures;
  class Registration;
  std::shared_ptr<Registration> registration_;
};

/// While it lives CUDA works on the textures and GL keeps off. Mapping waits (on the device) for
/// what GL has drawn, unmapping for what CUDA does in the stream. Kernels may be queued when it
/// goes: the texture and surface objects that they were given are kept until they are through.
/// A texture is to be mapped in one stream only.
class MappedTextures {
 public:
  /// All at once: mapping one by one costs as much for each. A texture is mapped only once at a
  /// time.
  MappedTextures(const std::vector<const SharedTexture*>& textures, cudaStream_t stream);
  MappedTextures(const MappedTextures&) = delete;
  MappedTextures& operator=(const MappedTextures&) = delete;
  ~MappedTextures();

  /// Of the texture at `index` in the list.
  ImageView view(std::size_t index) const { return access_.at(index).view(); }
  cudaArray_t array(std::size_t index) const { return arrays_.at(index); }

 private:
  void unmap() noexcept;
  void retire(std::size_t index) noexcept;

  std::vector<std::shared_ptr<SharedTexture::Registration>> registrations_;
  std::vector<cudaGraphicsResource_t> resources_;
  std::vector<cudaArray_t> arrays_;
  std::vector<ArrayAccess> access_;
  cudaStream_t stream_;
};

/// Draws with GL into a small shared texture, changes it with CUDA and reads it with GL: whether
/// textures of the current context are shared in truth. Throws Error with the reason if not.
void requireSharing();

}  // namespace rangepose::cuda
