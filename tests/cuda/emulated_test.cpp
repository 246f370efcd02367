// The emulated device: each fault that it is there for must show. If one does not, tests of the
// CUDA path prove nothing about it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "cuda/array.h"
#include "cuda/block.h"
#include "cuda/buffer.h"
#include "cuda/check.h"
#include "cuda/emulated/runtime.h"
#include "cuda/launch.h"
#include "cuda/stream.h"

namespace rangepose::cuda {
namespace {

using testing::HasSubstr;

constexpr int kThreads = 64;
constexpr int kPoisoned = static_cast<int>(0xa5a5a5a5U);

class EmulatedTest : public testing::Test {
 protected:
  void TearDown() override {
    emulated::setShuffle(0);
    emulated::failNothing();
  }
  cudaStream_t stream() const { return stream_.get(); }

  /// What the next wait says.
  std::string failure() {
    try {
      stream_.synchronize();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  Stream stream_;
};

std::vector<int> counted(int count) {
  std::vector<int> values(static_cast<std::size_t>(count));
  std::iota(values.begin(), values.end(), 0);
  return values;
}

TEST_F(EmulatedTest, WithoutAWaitNothingHasComeYet) {
  const std::vector<int> sent = counted(8);
  const Buffer<int> buffer(sent, stream());
  std::vector<int> back(8, -1);
  buffer.download(back.data(), back.size(), stream());
  EXPECT_EQ(back, std::vector<int>(8, -1)) << "a missing wait would go unnoticed";
  stream_.synchronize();
  EXPECT_EQ(back, sent);
}

TEST_F(EmulatedTest, AnotherStreamDoesNotWaitForThisOne) {
  const Stream other;
  const Buffer<int> buffer(counted(4), stream());
  EXPECT_EQ(buffer.download(4, other.get()), std::vector<int>(4, kPoisoned));
}

TEST_F(EmulatedTest, PinnedMemoryIsReadWhenItsTurnComes) {
  PinnedBuffer<int> pinned(1);
  Buffer<int> buffer(1);
  *pinned.data() = 1;
  buffer.upload(pinned.data(), 1, stream());
  *pinned.data() = 2;
  EXPECT_EQ(buffer.download(1, stream()).front(), 2) << "it was changed before it was sent";
}

TEST_F(EmulatedTest, WhatWasNotCopiedIsPoisoned) {
  Buffer<int> buffer(4);
  const std::vector<int> sent{1, 2, 3, 4};
  buffer.upload(sent.data(), 3, stream());
  EXPECT_EQ(buffer.download(4, stream()), (std::vector<int>{1, 2, 3, kPoisoned}));
}

TEST_F(EmulatedTest, CopiesBeyondTheirMemoryAreRefused) {
  const Buffer<int> buffer(4);
  const std::vector<int> sent(5);
  EXPECT_EQ(cudaMemcpyAsync(buffer.data(), sent.data(), 20, cudaMemcpyHostToDevice, stream()),
            cudaErrorInvalidValue);
  EXPECT_EQ(cudaMemcpyAsync(buffer.data(), sent.data(), 16, cudaMemcpyDeviceToHost, stream()),
            cudaErrorInvalidValue)
      << "the wrong way";
  EXPECT_EQ(cudaGetLastError(), cudaErrorInvalidValue);
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
}

using EmulatedDeathTest = EmulatedTest;

TEST_F(EmulatedDeathTest, TheHostCannotTouchTheDevicesMemory) {
  const Buffer<int> buffer(4);
  EXPECT_DEATH(static_cast<void>(*static_cast<volatile int*>(buffer.data())), "");
}

void beyondKernel(int* values, int count) { values[count] = 1; }

TEST_F(EmulatedDeathTest, AKernelCannotWriteBeyondItsMemory) {
  const Buffer<int> buffer(4);
  EXPECT_DEATH(
      {
        launch(beyondKernel, 1, 1, stream(), buffer.data(), 4);
        stream_.synchronize();
      },
      "");
}

void readFloatKernel(cudaTextureObject_t texture, float* into) {
  *into = tex2D<float>(texture, 0.5f, 0.5f);
}
void writeFloatKernel(cudaSurfaceObject_t surface, int x_bytes) {
  surf2Dwrite(1.0f, surface, x_bytes, 0);
}

TEST_F(EmulatedTest, AnotherChannelFormatIsAnError) {
  const Buffer<float> result(1);
  const Array array(Element::kInt, 4, 4);
  launch(readFloatKernel, 1, 1, stream(), array.view().texture, result.data());
  EXPECT_THAT(failure(), HasSubstr("another channel format"));
}

TEST_F(EmulatedTest, ATextureThatIsGoneIsAnError) {
  const Buffer<float> result(1);
  std::optional<Array> array(std::in_place, Element::kFloat, 4, 4);
  const ImageView view = array->view();
  array.reset();
  launch(readFloatKernel, 1, 1, stream(), view.texture, result.data());
  EXPECT_THAT(failure(), HasSubstr("is gone"));
}

TEST_F(EmulatedTest, AnArrayThatIsFreedUnderItsTextureIsAnError) {
  const cudaChannelFormatDesc format =
      cudaCreateChannelDesc(32, 0, 0, 0, cudaChannelFormatKindFloat);
  cudaArray_t array = nullptr;
  RP_CUDA(cudaMallocArray(&array, &format, 4, 4, cudaArraySurfaceLoadStore));
  const Buffer<float> result(1);
  const ArrayAccess access(array, 4, 4);
  RP_CUDA(cudaFreeArray(array));
  launch(readFloatKernel, 1, 1, stream(), access.view().texture, result.data());
  EXPECT_THAT(failure(), HasSubstr("is gone"));
}

TEST_F(EmulatedTest, AWriteBesideASurfaceIsAnError) {
  const Array array(Element::kFloat, 4, 4);
  launch(writeFloatKernel, 1, 1, stream(), array.view().surface, 16);
  EXPECT_THAT(failure(), HasSubstr("beside the surface"));
}

TEST_F(EmulatedTest, BlocksThatNoDeviceRunsAreRefused) {
  const Buffer<int> buffer(4);
  launch(beyondKernel, 1, 1025, stream(), buffer.data(), 0);
  EXPECT_EQ(cudaGetLastError(), cudaErrorInvalidConfiguration);
  launch(beyondKernel, dim3(1, 65536), 1, stream(), buffer.data(), 0);
  EXPECT_EQ(cudaGetLastError(), cudaErrorInvalidConfiguration);
}

/// Each thread takes what its neighbour has written.
template <bool kWithBarrier>
void neighbourKernel(int* into) {
  __shared__ int values[kThreads];
  DeviceBlock<kThreads> block;
  block.forEachThread([&](int thread) { values[thread] = -1; });
  block.barrier();
  block.forEachThread([&](int thread) { values[thread] = thread; });
  if (kWithBarrier) block.barrier();
  block.forEachThread([&](int thread) { into[thread] = values[(thread + 1) % kThreads]; });
}

std::vector<int> neighbours() {
  std::vector<int> expected;
  for (int thread = 0; thread < kThreads; ++thread) expected.push_back((thread + 1) % kThreads);
  return expected;
}

TEST_F(EmulatedTest, ThreadsMeetAtBarriers) {
  const Buffer<int> result(kThreads);
  for (const unsigned seed : {0U, 1U, 2U}) {
    emulated::setShuffle(seed);
    launch(neighbourKernel<true>, 1, kThreads, stream(), result.data());
    EXPECT_EQ(result.download(kThreads, stream()), neighbours()) << seed;
  }
}

TEST_F(EmulatedTest, AMissingBarrierShows) {
  const Buffer<int> result(kThreads);
  for (const unsigned seed : {0U, 1U, 2U}) {
    emulated::setShuffle(seed);
    launch(neighbourKernel<false>, 1, kThreads, stream(), result.data());
    EXPECT_NE(result.download(kThreads, stream()), neighbours()) << seed;
  }
}

void countKernel(const int* values, int* into) {
  const int count = __syncthreads_count(values[threadIdx.x]);
  into[threadIdx.x] = count;
}

TEST_F(EmulatedTest, ThreadsAreCountedAtABarrier) {
  std::vector<int> values(kThreads, 0);
  values[3] = values[40] = 1;
  const Buffer<int> in(values, stream());
  const Buffer<int> out(kThreads);
  launch(countKernel, 1, kThreads, stream(), in.data(), out.data());
  EXPECT_EQ(out.download(kThreads, stream()), std::vector<int>(kThreads, 2));
}

/// Each block writes its number: the last one stays.
void lastBlockKernel(int* last) { *last = static_cast<int>(blockIdx.x); }

TEST_F(EmulatedTest, AnOrderOfBlocksThatMattersShows) {
  const Buffer<int> last(1);
  std::set<int> seen;
  for (unsigned seed = 0; seed < 8; ++seed) {
    emulated::setShuffle(seed);
    launch(lastBlockKernel, 16, 1, stream(), last.data());
    seen.insert(last.download(1, stream()).front());
  }
  EXPECT_GT(seen.size(), 1U);
}

void sumKernel(const int* values, int* into) {
  DeviceBlock<kThreads> block;
  DeviceBlock<kThreads>::PerThread<int> own;
  block.forEachThread([&](int thread) { own[thread] = values[thread]; });
  block.sum<int>(own, [&](int sum) { *into = sum; });
}

TEST_F(EmulatedTest, ABlockSumsUp) {
  const Buffer<int> values(counted(kThreads), stream());
  const Buffer<int> sum(1);
  launch(sumKernel, 1, kThreads, stream(), values.data(), sum.data());
  EXPECT_EQ(sum.download(1, stream()).front(), kThreads * (kThreads - 1) / 2);
}

TEST_F(EmulatedTest, ABlockOfAnotherSizeThanItIsWrittenForIsAnError) {
  const Buffer<int> values(counted(kThreads), stream());
  const Buffer<int> sum(1);
  launch(sumKernel, 1, kThreads / 2, stream(), values.data(), sum.data());
  EXPECT_THAT(failure(), HasSubstr("another size"));
}

TEST_F(EmulatedTest, WhatIsNotFreedIsCounted) {
  const int before = emulated::alive().all();
  {
    const Buffer<int> buffer(4);
    const Array array(Element::kFloat, 4, 4);
    EXPECT_EQ(emulated::alive().all(), before + 4) << "memory, array, texture, surface";
  }
  EXPECT_EQ(emulated::alive().all(), before);
  const Buffer<int> buffer(4);
  EXPECT_EQ(cudaFree(buffer.data() + 1), cudaErrorInvalidDevicePointer);
  EXPECT_EQ(cudaGetLastError(), cudaErrorInvalidDevicePointer);
}

TEST_F(EmulatedTest, ACallFailsWhereItIsTold) {
  emulated::failCall("cudaMalloc", 2, cudaErrorMemoryAllocation);
  EXPECT_NO_THROW(Buffer<int>(4));
  try {
    const Buffer<int> buffer(4);
    FAIL() << "it did not fail";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("cudaErrorMemoryAllocation"));
  }
  EXPECT_NO_THROW(Buffer<int>(4));
}

}  // namespace
}  // namespace rangepose::cuda
