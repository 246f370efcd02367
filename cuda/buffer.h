// Linear memory with an owner: on the device, and pinned in the host for copies that do not wait.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "cuda/check.h"
#include "cuda/stream.h"

namespace rangepose::cuda {

/// `count` values of T on the device. Copies are put into the stream and do not wait, but for
/// `download` into a vector. Allocating waits for the device: not inside of a frame.
template <typename T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;
  /// Content undefined.
  explicit Buffer(std::size_t count) : count_(count) {
    if (count > 0) RP_CUDA(cudaMalloc(reinterpret_cast<void**>(&data_), count * sizeof(T)));
  }
  Buffer(const std::vector<T>& values, cudaStream_t stream) : Buffer(values.size()) {
    upload(values.data(), values.size(), stream);
  }
  Buffer(Buffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() {
    if (data_ != nullptr) cudaFree(data_);
  }

  T* data() const { return data_; }
  std::size_t size() const { return count_; }

  /// At least `count` values; content undefined afterwards if it grew.
  void reserve(std::size_t count) {
    if (count > count_) *this = Buffer(count);
  }
  /// `count` values behind the first `skipped`. From pageable memory it returns once `from` may be
  /// changed again; pinned memory must be left alone until the stream has come past it.
  void upload(const T* from, std::size_t count, cudaStream_t stream, std::size_t skipped = 0) {
    need(skipped + count);
    if (count == 0) return;
    RP_CUDA(
        cudaMemcpyAsync(data_ + skipped, from, count * sizeof(T), cudaMemcpyHostToDevice, stream));
  }
  void download(T* into, std::size_t count, cudaStream_t stream) const {
    need(count);
    if (count == 0) return;
    RP_CUDA(cudaMemcpyAsync(into, data_, count * sizeof(T), cudaMemcpyDeviceToHost, stream));
  }
  /// The first `count` values; waits for them.
  std::vector<T> download(std::size_t count, cudaStream_t stream) const {
    std::vector<T> values(count);
    const Landing landing(stream);
    download(values.data(), count, stream);
    RP_CUDA(cudaStreamSynchronize(stream));
    return values;
  }

 private:
  void need(std::size_t count) const {
    RP_CHECK(count <= count_,
             "buffer of " + std::to_string(count_) + " values, asked for " + std::to_string(count));
  }

  T* data_ = nullptr;
  std::size_t count_ = 0;
};

/// `count` values of T in host memory that the device copies from and to by itself.
template <typename T>
class PinnedBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  PinnedBuffer() = default;
  /// Content undefined.
  explicit PinnedBuffer(std::size_t count) : count_(count) {
    if (count > 0) RP_CUDA(cudaMallocHost(reinterpret_cast<void**>(&data_), count * sizeof(T)));
  }
  PinnedBuffer(PinnedBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}
  PinnedBuffer& operator=(PinnedBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
    return *this;
  }
  PinnedBuffer(const PinnedBuffer&) = delete;
  PinnedBuffer& operator=(const PinnedBuffer&) = delete;
  ~PinnedBuffer() {
    if (data_ != nullptr) cudaFreeHost(data_);
  }

  T* data() const { return data_; }
  std::size_t size() const { return count_; }
  void reserve(std::size_t count) {
    if (count > count_) *this = PinnedBuffer(count);
  }

 private:
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace rangepose::cuda
