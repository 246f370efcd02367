// An image that kernels read as a texture and write as a surface.
#pragma once

#include "cuda/image_view.h"

namespace rangepose::cuda {

enum class Element {
  kFloat,   ///< Image<float>
  kFloat4,  ///< Image<glm::vec4>, Image<EdtTexel>
  kInt,     ///< Image<std::int32_t>
};

/// [bytes]
int bytesOf(Element element);

/// The texture and the surface of a CUDA array that belongs to someone else and must outlive them.
class ArrayAccess {
 public:
  ArrayAccess() = default;
  ArrayAccess(cudaArray_t array, int width, int height);
  ArrayAccess(ArrayAccess&& other) noexcept;
  ArrayAccess& operator=(ArrayAccess&& other) noexcept;
  ArrayAccess(const ArrayAccess&) = delete;
  ArrayAccess& operator=(const ArrayAccess&) = delete;
  ~ArrayAccess();

  const ImageView& view() const { return view_; }

 private:
  ImageView view_;
};

/// Owns its memory. Allocating and freeing wait for the device: not inside of a frame.
class Array {
 public:
  /// Content undefined.
  Array(Element element, int width, int height);
  Array(Array&& other) noexcept;
  Array& operator=(Array&& other) noexcept;
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array();

  ImageView view() const { return access_.view(); }
  cudaArray_t array() const { return array_; }
  Element element() const { return element_; }
  int width() const { return access_.view().width; }
  int height() const { return access_.view().height; }

  /// width * height elements, row by row. Returns once pageable memory may be changed again.
  void upload(const void* elements, cudaStream_t stream);
  /// Does not wait: `elements` are there once the stream has come past it.
  void download(void* elements, cudaStream_t stream) const;

 private:
  Element element_;
  cudaArray_t array_ = nullptr;
  ArrayAccess access_;
};

/// Copies rows of elements to or from an array that is owned or mapped; does not wait for the
/// device.
void uploadTo(cudaArray_t array,
              Element element,
              int width,
              int height,
              const void* from,
              cudaStream_t stream);
void downloadFrom(
    cudaArray_t array, Element element, int width, int height, void* into, cudaStream_t stream);

}  // namespace rangepose::cuda
