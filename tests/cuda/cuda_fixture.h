// Kernels on a device: skipped where there is none, failed where RP_REQUIRE_BACKENDS names cuda.
#pragma once

#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "core/glm.h"
#include "core/image.h"
#include "cuda/array.h"
#include "cuda/buffer.h"
#include "cuda/check.h"
#include "cuda/stream.h"
#include "support/backends.h"

namespace rangepose::test {

/// Each test must have launched kernels of its own: one that compares the host with itself proves
/// nothing.
class CudaFixture : public testing::Test {
 protected:
  void SetUp() override {
    int devices = 0;
    const cudaError_t result = cudaGetDeviceCount(&devices);
    if (result != cudaSuccess || devices == 0) {
      const std::string why = std::string("no CUDA device: ") + cudaGetErrorString(result);
      if (backendRequired("cuda")) FAIL() << why;
      GTEST_SKIP() << why;
    }
    stream_.emplace();
    launched_before_ = cuda::launches();
  }
  void TearDown() override {
    if (!stream_) return;
    stream_->synchronize();
    EXPECT_GT(cuda::launches(), launched_before_) << "nothing ran on the device";
  }

  cudaStream_t stream() const { return stream_->get(); }

  template <typename T>
  cuda::Buffer<T> toDevice(const std::vector<T>& values) {
    return cuda::Buffer<T>(values, stream());
  }
  cuda::Array toDevice(const Image<float>& image) {
    return upload(cuda::Element::kFloat, image.width(), image.height(), image.data());
  }
  cuda::Array toDevice(const Image<glm::vec4>& image) {
    return upload(cuda::Element::kFloat4, image.width(), image.height(), image.data());
  }
  /// Filled with a value that no stage writes.
  cuda::Array poisoned(int width, int height) {
    return toDevice(Image<float>(width, height, -777.0f));
  }
  template <typename T>
  Image<T> toHost(const cuda::Array& array) {
    return toHost<T>(array.view(), array.array(), array.element());
  }

 private:
  cuda::Array upload(cuda::Element element, int width, int height, const void* from) {
    cuda::Array array(element, width, height);
    array.upload(from, stream());
    return array;
  }
  template <typename T>
  Image<T> toHost(const cuda::ImageView& view, cudaArray_t array, cuda::Element element) {
    Image<T> image(view.width, view.height);
    cuda::downloadFrom(array, element, view.width, view.height, image.data(), stream());
    stream_->synchronize();
    return image;
  }

  std::optional<cuda::Stream> stream_;
  std::int64_t launched_before_ = 0;
};

}  // namespace rangepose::test
