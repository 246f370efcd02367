#include "cuda/array.h"

#include <string>
#include <utility>

#include "core/error.h"
#include "cuda/check.h"

namespace rangepose::cuda {
namespace {

cudaChannelFormatDesc formatOf(Element element) {
  switch (element) {
    case Element::kFloat:
      return cudaCreateChannelDesc(32, 0, 0, 0, cudaChannelFormatKindFloat);
    case Element::kFloat4:
      return cudaCreateChannelDesc(32, 32, 32, 32, cudaChannelFormatKindFloat);
    case Element::kInt:
      return cudaCreateChannelDesc(32, 0, 0, 0, cudaChannelFormatKindSigned);
  }
  throw Error("CUDA array: unknown element");
}

std::size_t rowBytes(Element element, int width) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(bytesOf(element));
}

cudaArray_t allocate(Element element, int width, int height) {
  RP_CHECK(width > 0 && height > 0,
           "CUDA array of " + std::to_string(width) + "x" + std::to_string(height) + " px");
  const cudaChannelFormatDesc format = formatOf(element);
  cudaArray_t array = nullptr;
  RP_CUDA(cudaMallocArray(&array,
                          &format,
                          static_cast<std::size_t>(width),
                          static_cast<std::size_t>(height),
                          cudaArraySurfaceLoadStore));
  return array;
}

}  // namespace

int bytesOf(Element element) { return element == Element::kFloat4 ? 16 : 4; }

ArrayAccess::ArrayAccess(cudaArray_t array, int width, int height) {
  view_.width = width;
  view_.height = height;
  cudaResourceDesc resource{};
  resource.resType = cudaResourceTypeArray;
  resource.res.array.array = array;
  cudaTextureDesc sampling{};
  sampling.addressMode[0] = cudaAddressModeClamp;
  sampling.addressMode[1] = cudaAddressModeClamp;
  sampling.filterMode = cudaFilterModePoint;
  sampling.readMode = cudaReadModeElementType;
  RP_CUDA(cudaCreateTextureObject(&view_.texture, &resource, &sampling, nullptr));
  const cudaError_t result = cudaCreateSurfaceObject(&view_.surface, &resource);
  if (result == cudaSuccess) return;
  cudaDestroyTextureObject(view_.texture);
  RP_CUDA(result);
}

ArrayAccess::ArrayAccess(ArrayAccess&& other) noexcept : view_(std::exchange(other.view_, {})) {}

ArrayAccess& ArrayAccess::operator=(ArrayAccess&& other) noexcept {
  std::swap(view_, other.view_);
  return *this;
}

ArrayAccess::~ArrayAccess() {
  if (view_.surface != 0) cudaDestroySurfaceObject(view_.surface);
  if (view_.texture != 0) cudaDestroyTextureObject(view_.texture);
}

Array::Array(Element element, int width, int height)
    : element_(element), array_(allocate(element, width, height)) {
  try {
    access_ = ArrayAccess(array_, width, height);
  } catch (...) {
    cudaFreeArray(array_);
    throw;
  }
}

Array::Array(Array&& other) noexcept
    : element_(other.element_),
      array_(std::exchange(other.array_, nullptr)),
      access_(std::move(other.access_)) {}

Array& Array::operator=(Array&& other) noexcept {
  std::swap(element_, other.element_);
  std::swap(array_, other.array_);
  std::swap(access_, other.access_);
  return *this;
}

Array::~Array() {
  if (array_ == nullptr) return;
  // Kernels that use its texture and surface may still be queued.
  cudaDeviceSynchronize();
  access_ = ArrayAccess();
  cudaFreeArray(array_);
}

void Array::upload(const void* elements, cudaStream_t stream) {
  uploadTo(array_, element_, width(), height(), elements, stream);
}

void Array::download(void* elements, cudaStream_t stream) const {
  downloadFrom(array_, element_, width(), height(), elements, stream);
}

void uploadTo(cudaArray_t array,
              Element element,
              int width,
              int height,
              const void* from,
              cudaStream_t stream) {
  const std::size_t row = rowBytes(element, width);
  RP_CUDA(cudaMemcpy2DToArrayAsync(array,
                                   0,
                                   0,
                                   from,
                                   row,
                                   row,
                                   static_cast<std::size_t>(height),
                                   cudaMemcpyHostToDevice,
                                   stream));
}

void downloadFrom(
    cudaArray_t array, Element element, int width, int height, void* into, cudaStream_t stream) {
  const std::size_t row = rowBytes(element, width);
  RP_CUDA(cudaMemcpy2DFromArrayAsync(into,
                                     row,
                                     array,
                                     0,
                                     0,
                                     row,
                                     static_cast<std::size_t>(height),
                                     cudaMemcpyDeviceToHost,
                                     stream));
}

}  // namespace rangepose::cuda
