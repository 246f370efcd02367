// Memory and copies of the emulated device.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "cuda/emulated/launch.h"
#include "cuda/emulated/runtime.h"

namespace rangepose::cuda::emulated {
namespace {

/// What nobody has written shows as this.
constexpr int kPoison = 0xa5;
constexpr std::size_t kMostBytes = std::size_t{8} << 30U;
/// Of the start of an allocation; its end lies so near to the end of its last page.
constexpr std::size_t kAligned = 16;

struct Pages {
  std::byte* first = nullptr;
  std::size_t bytes = 0;  ///< of the pages that can be used
  std::size_t asked = 0;
};

/// By the address that the runtime gave.
std::map<std::uintptr_t, Pages>& allocations() {
  static auto* const all = new std::map<std::uintptr_t, Pages>();
  return *all;
}
std::map<std::uintptr_t, std::size_t>& pinned() {
  static auto* const all = new std::map<std::uintptr_t, std::size_t>();
  return *all;
}
int open_count = 0;

std::size_t pageBytes() {
  static const auto kBytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return kBytes;
}

std::uintptr_t addressOf(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); }

/// Of what `pointer` lies in; null outside of device memory.
const std::pair<const std::uintptr_t, Pages>* allocationOf(const void* pointer) {
  auto next = allocations().upper_bound(addressOf(pointer));
  if (next == allocations().begin()) return nullptr;
  const auto& found = *--next;
  return addressOf(pointer) < found.first + found.second.asked ? &found : nullptr;
}

bool isDevice(const void* pointer, std::size_t bytes) {
  const auto* found = allocationOf(pointer);
  return found != nullptr && addressOf(pointer) + bytes <= found->first + found->second.asked;
}

bool isPinned(const void* pointer, std::size_t bytes) {
  auto next = pinned().upper_bound(addressOf(pointer));
  if (next == pinned().begin()) return false;
  --next;
  return addressOf(pointer) + bytes <= next->first + next->second;
}

/// What work may read later: pinned memory as it is then, other memory as it is now.
std::shared_ptr<const std::byte> sourceOf(const void* from, std::size_t bytes) {
  const auto* start = static_cast<const std::byte*>(from);
  if (isPinned(from, bytes)) return {std::shared_ptr<void>(), start};
  std::shared_ptr<std::byte> copy(new std::byte[bytes], std::default_delete<std::byte[]>());
  std::memcpy(copy.get(), start, bytes);
  return copy;
}

}  // namespace

void* allocateDevice(std::size_t bytes) {
  if (bytes == 0 || bytes > kMostBytes) return nullptr;
  const std::size_t page = pageBytes();
  const std::size_t usable = (bytes + page - 1) / page * page;
  void* mapped = mmap(
      nullptr, usable + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) return nullptr;
  Pages pages{static_cast<std::byte*>(mapped) + page, usable, bytes};
  mprotect(pages.first, usable, PROT_READ | PROT_WRITE);
  std::memset(pages.first, kPoison, usable);
  if (open_count == 0) mprotect(pages.first, usable, PROT_NONE);
  std::byte* const start = pages.first + (usable - bytes) / kAligned * kAligned;
  allocations().emplace(addressOf(start), pages);
  return start;
}

void freeDevice(void* memory) {
  const auto found = allocations().find(addressOf(memory));
  if (found == allocations().end()) return;
  munmap(found->second.first - pageBytes(), found->second.bytes + 2 * pageBytes());
  allocations().erase(found);
}

namespace {

void protectAll(int protection) {
  for (const auto& [start, pages] : allocations()) mprotect(pages.first, pages.bytes, protection);
}

}  // namespace

OpenMemory::OpenMemory() {
  if (open_count++ == 0) protectAll(PROT_READ | PROT_WRITE);
}
OpenMemory::~OpenMemory() {
  if (--open_count == 0) protectAll(PROT_NONE);
}

}  // namespace rangepose::cuda::emulated

using namespace rangepose::cuda::emulated;

cudaError_t cudaMalloc(void** pointer, std::size_t bytes) {
  const Call call("cudaMalloc");
  if (call.injected()) return remembered(*call.injected());
  *pointer = allocateDevice(bytes);
  if (*pointer == nullptr) return remembered(cudaErrorMemoryAllocation);
  ++counts().allocations;
  return cudaSuccess;
}

cudaError_t cudaFree(void* pointer) {
  const Call call("cudaFree");
  if (call.injected()) return remembered(*call.injected());
  if (pointer == nullptr) return cudaSuccess;
  if (!allocations().contains(addressOf(pointer))) {
    return remembered(cudaErrorInvalidDevicePointer);
  }
  const cudaError_t result = drain(std::nullopt);
  freeDevice(pointer);
  --counts().allocations;
  return remembered(result);
}

cudaError_t cudaMallocHost(void** pointer, std::size_t bytes) {
  const Call call("cudaMallocHost");
  if (call.injected()) return remembered(*call.injected());
  *pointer = std::malloc(bytes);
  if (*pointer == nullptr) return remembered(cudaErrorMemoryAllocation);
  std::memset(*pointer, kPoison, bytes);
  pinned().emplace(addressOf(*pointer), bytes);
  ++counts().pinned;
  return cudaSuccess;
}

cudaError_t cudaFreeHost(void* pointer) {
  const Call call("cudaFreeHost");
  if (call.injected()) return remembered(*call.injected());
  if (pinned().erase(addressOf(pointer)) == 0) return remembered(cudaErrorInvalidValue);
  const cudaError_t result = drain(std::nullopt);
  std::free(pointer);
  --counts().pinned;
  return remembered(result);
}

cudaError_t cudaMemcpyAsync(
    void* into, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream) {
  const Call call("cudaMemcpyAsync");
  if (call.injected()) return remembered(*call.injected());
  if (isDevice(from, bytes) != (kind != cudaMemcpyHostToDevice) ||
      isDevice(into, bytes) != (kind != cudaMemcpyDeviceToHost) ||
      (kind == cudaMemcpyHostToDevice && allocationOf(from) != nullptr) ||
      (kind == cudaMemcpyDeviceToHost && allocationOf(into) != nullptr)) {
    return remembered(cudaErrorInvalidValue);
  }
  if (kind == cudaMemcpyHostToDevice) {
    queueWork(stream, [into, bytes, source = sourceOf(from, bytes)] {
      std::memcpy(into, source.get(), bytes);
    });
  } else {
    queueWork(stream, [into, from, bytes] { std::memmove(into, from, bytes); });
  }
  return cudaSuccess;
}

cudaError_t cudaMemsetAsync(void* into, int value, std::size_t bytes, cudaStream_t stream) {
  const Call call("cudaMemsetAsync");
  if (call.injected()) return remembered(*call.injected());
  if (!isDevice(into, bytes)) return remembered(cudaErrorInvalidValue);
  queueWork(stream, [into, value, bytes] { std::memset(into, value, bytes); });
  return cudaSuccess;
}

namespace {

/// Copies rows between an array's texels and memory of the host.
struct Rows {
  std::byte* texels;
  std::size_t texel_pitch;
  std::size_t pitch;
  std::size_t width_bytes;
  std::size_t height;
};

bool isWhole(cudaArray_t array,
             std::size_t x_bytes,
             std::size_t y,
             std::size_t pitch,
             std::size_t width_bytes,
             std::size_t height,
             Rows& rows);

}  // namespace

cudaError_t cudaMemcpy2DToArrayAsync(cudaArray_t array,
                                     std::size_t x_bytes,
                                     std::size_t y,
                                     const void* from,
                                     std::size_t pitch,
                                     std::size_t width_bytes,
                                     std::size_t height,
                                     cudaMemcpyKind kind,
                                     cudaStream_t stream) {
  const Call call("cudaMemcpy2DToArrayAsync");
  if (call.injected()) return remembered(*call.injected());
  Rows rows{};
  if (kind != cudaMemcpyHostToDevice || allocationOf(from) != nullptr ||
      !isWhole(array, x_bytes, y, pitch, width_bytes, height, rows)) {
    return remembered(cudaErrorInvalidValue);
  }
  const std::size_t bytes = (height - 1) * pitch + width_bytes;
  queueWork(stream, [rows, source = sourceOf(from, bytes)] {
    for (std::size_t row = 0; row < rows.height; ++row) {
      std::memcpy(
          rows.texels + row * rows.texel_pitch, source.get() + row * rows.pitch, rows.width_bytes);
    }
  });
  return cudaSuccess;
}

cudaError_t cudaMemcpy2DFromArrayAsync(void* into,
                                       std::size_t pitch,
                                       cudaArray_t array,
                                       std::size_t x_bytes,
                                       std::size_t y,
                                       std::size_t width_bytes,
                                       std::size_t height,
                                       cudaMemcpyKind kind,
                                       cudaStream_t stream) {
  const Call call("cudaMemcpy2DFromArrayAsync");
  if (call.injected()) return remembered(*call.injected());
  Rows rows{};
  if (kind != cudaMemcpyDeviceToHost || allocationOf(into) != nullptr ||
      !isWhole(array, x_bytes, y, pitch, width_bytes, height, rows)) {
    return remembered(cudaErrorInvalidValue);
  }
  queueWork(stream, [rows, into] {
    for (std::size_t row = 0; row < rows.height; ++row) {
      std::memcpy(static_cast<std::byte*>(into) + row * rows.pitch,
                  rows.texels + row * rows.texel_pitch,
                  rows.width_bytes);
    }
  });
  return cudaSuccess;
}

struct cudaArray {
  TexelKind kind;
  int width;
  int height;
  void* texels;  ///< null once it is freed
};

namespace {

bool isWhole(cudaArray_t array,
             std::size_t x_bytes,
             std::size_t y,
             std::size_t pitch,
             std::size_t width_bytes,
             std::size_t height,
             Rows& rows) {
  if (array == nullptr || array->texels == nullptr || height == 0 || width_bytes == 0 ||
      pitch < width_bytes)
    return false;
  const std::size_t row_bytes = static_cast<std::size_t>(array->width) * bytesOf(array->kind);
  if (x_bytes + width_bytes > row_bytes || y + height > static_cast<std::size_t>(array->height))
    return false;
  rows = {static_cast<std::byte*>(array->texels) + y * row_bytes + x_bytes,
          row_bytes,
          pitch,
          width_bytes,
          height};
  return true;
}

}  // namespace

namespace rangepose::cuda::emulated {
namespace {

// Arrays, textures and surfaces are never really gone: one that is used too late is known as such.
std::deque<cudaArray>& arrays() {
  static auto* const all = new std::deque<cudaArray>();
  return *all;
}

}  // namespace

TexelKind kindOf(const cudaChannelFormatDesc& format) {
  if (format.f == cudaChannelFormatKindSigned) return TexelKind::kInt;
  return format.y == 0 ? TexelKind::kFloat : TexelKind::kFloat4;
}

std::size_t bytesOf(TexelKind kind) { return kind == TexelKind::kFloat4 ? 16 : 4; }

cudaArray_t makeArray(TexelKind kind, int width, int height) {
  void* texels = allocateDevice(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                bytesOf(kind));
  return texels == nullptr ? nullptr
                           : &arrays().emplace_back(cudaArray{kind, width, height, texels});
}

void dropArray(cudaArray_t array) {
  freeDevice(array->texels);
  array->texels = nullptr;
}

void* texelsOf(cudaArray_t array) { return array->texels; }

}  // namespace rangepose::cuda::emulated

cudaChannelFormatDesc cudaCreateChannelDesc(
    int x, int y, int z, int w, cudaChannelFormatKind kind) {
  return {x, y, z, w, kind};
}

cudaError_t cudaMallocArray(cudaArray_t* array,
                            const cudaChannelFormatDesc* format,
                            std::size_t width,
                            std::size_t height,
                            unsigned /*flags*/) {
  const Call call("cudaMallocArray");
  if (call.injected()) return remembered(*call.injected());
  constexpr std::size_t kMostSide = 65536;
  if (width == 0 || height == 0 || width > kMostSide || height > kMostSide) {
    return remembered(cudaErrorInvalidValue);
  }
  *array = makeArray(kindOf(*format), static_cast<int>(width), static_cast<int>(height));
  if (*array == nullptr) return remembered(cudaErrorMemoryAllocation);
  ++counts().arrays;
  return cudaSuccess;
}

cudaError_t cudaFreeArray(cudaArray_t array) {
  const Call call("cudaFreeArray");
  if (call.injected()) return remembered(*call.injected());
  if (array == nullptr) return cudaSuccess;
  if (array->texels == nullptr) return remembered(cudaErrorInvalidValue);
  dropArray(array);
  --counts().arrays;
  return cudaSuccess;
}

namespace {

struct View {
  const cudaArray* array;
  bool alive;
};

std::deque<View>& views() {
  static auto* const all = new std::deque<View>();
  return *all;
}

View* viewOf(unsigned long long handle) { return reinterpret_cast<View*>(handle); }

cudaError_t makeView(unsigned long long* handle, const cudaResourceDesc* resource) {
  if (resource->resType != cudaResourceTypeArray || resource->res.array.array == nullptr ||
      resource->res.array.array->texels == nullptr) {
    return remembered(cudaErrorInvalidValue);
  }
  *handle = reinterpret_cast<unsigned long long>(
      &views().emplace_back(View{resource->res.array.array, true}));
  ++counts().textures;
  return cudaSuccess;
}

cudaError_t dropView(unsigned long long handle) {
  View* view = viewOf(handle);
  if (view == nullptr || !view->alive) return remembered(cudaErrorInvalidValue);
  view->alive = false;
  --counts().textures;
  return cudaSuccess;
}

}  // namespace

cudaError_t cudaCreateTextureObject(cudaTextureObject_t* texture,
                                    const cudaResourceDesc* resource,
                                    const cudaTextureDesc* sampling,
                                    const cudaResourceViewDesc* /*view*/) {
  const Call call("cudaCreateTextureObject");
  if (call.injected()) return remembered(*call.injected());
  // What else there is, nobody here asks for.
  if (sampling->addressMode[0] != cudaAddressModeClamp ||
      sampling->addressMode[1] != cudaAddressModeClamp ||
      sampling->filterMode != cudaFilterModePoint || sampling->normalizedCoords != 0) {
    return remembered(cudaErrorInvalidValue);
  }
  return makeView(texture, resource);
}

cudaError_t cudaDestroyTextureObject(cudaTextureObject_t texture) {
  const Call call("cudaDestroyTextureObject");
  if (call.injected()) return remembered(*call.injected());
  return dropView(texture);
}

cudaError_t cudaCreateSurfaceObject(cudaSurfaceObject_t* surface,
                                    const cudaResourceDesc* resource) {
  const Call call("cudaCreateSurfaceObject");
  if (call.injected()) return remembered(*call.injected());
  return makeView(surface, resource);
}

cudaError_t cudaDestroySurfaceObject(cudaSurfaceObject_t surface) {
  const Call call("cudaDestroySurfaceObject");
  if (call.injected()) return remembered(*call.injected());
  return dropView(surface);
}

namespace rangepose::cuda::emulated {
namespace {

std::byte* texelIn(const View& view, int x, int y) {
  return static_cast<std::byte*>(view.array->texels) +
         (static_cast<std::size_t>(y) * static_cast<std::size_t>(view.array->width) +
          static_cast<std::size_t>(x)) *
             bytesOf(view.array->kind);
}

const View& checkedView(unsigned long long handle, TexelKind kind) {
  const View* view = viewOf(handle);
  if (view == nullptr) failKernel("a texture or surface that was never made");
  if (!view->alive || view->array->texels == nullptr) {
    failKernel("a texture or surface that is gone");
  }
  if (view->array->kind != kind) failKernel("a texture or surface of another channel format");
  return *view;
}

}  // namespace

const void* texelAt(cudaTextureObject_t texture, int x, int y, TexelKind kind) {
  const View& view = checkedView(texture, kind);
  const int column = x < 0 ? 0 : x < view.array->width ? x : view.array->width - 1;
  const int row = y < 0 ? 0 : y < view.array->height ? y : view.array->height - 1;
  return texelIn(view, column, row);
}

void* texelOf(cudaSurfaceObject_t surface, int x_bytes, int y, TexelKind kind) {
  const View& view = checkedView(surface, kind);
  const int bytes = static_cast<int>(bytesOf(kind));
  if (x_bytes < 0 || x_bytes % bytes != 0 || x_bytes / bytes >= view.array->width || y < 0 ||
      y >= view.array->height) {
    failKernel("a write beside the surface");
  }
  return texelIn(view, x_bytes / bytes, y);
}

}  // namespace rangepose::cuda::emulated
