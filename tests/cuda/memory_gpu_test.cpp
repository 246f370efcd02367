// Images and buffers on a device, and textures that GL shares with it.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "cuda/cuda_fixture.h"
#include "cuda/cuda_path.h"
#include "cuda/device_image.h"
#include "cuda/shared_texture.h"
#include "gles/framebuffer.h"

namespace rangepose::cuda {
namespace {

Image<float> ramp(int width, int height) {
  Image<float> image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = 0.5f + static_cast<float>(i);
  return image;
}

/// With a stream, and a context whose textures CUDA shares where `interop` says so.
class MemoryGpuTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    try {
      path_ = std::make_unique<Path>(openPath({parseInterop(GetParam()), false}));
      stream_.emplace();
    } catch (const Unavailable& error) {
      const std::string interop = GetParam();
      if (test::backendRequired(interop == "copy" ? "cuda" : "cuda_" + interop)) {
        FAIL() << error.what();
      }
      GTEST_SKIP() << error.what();
    }
  }
  DeviceImage::Memory memory() const {
    return path_->interop == Interop::kCopy ? DeviceImage::Memory::kOwn
                                            : DeviceImage::Memory::kShared;
  }
  cudaStream_t stream() const { return stream_->get(); }

  std::unique_ptr<Path> path_;
  std::optional<Stream> stream_;
};

INSTANTIATE_TEST_SUITE_P(Interops,
                         MemoryGpuTest,
                         testing::Values("gles", "gl", "copy"),
                         [](const auto& interop) { return std::string(interop.param); });

/// By copies nothing is shared.
class SharedMemoryGpuTest : public MemoryGpuTest {};
INSTANTIATE_TEST_SUITE_P(Interops,
                         SharedMemoryGpuTest,
                         testing::Values("gles", "gl"),
                         [](const auto& interop) { return std::string(interop.param); });

TEST_P(MemoryGpuTest, ImagesComeBackAsTheyWent) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(33, 17), std::pair(128, 128)}) {
    const Image<float> sent = ramp(width, height);
    const DeviceImage image(memory(), Element::kFloat, width, height);
    Image<float> back(width, height, -1.0f);
    const Frame frame({&image}, stream());
    frame.upload(image, sent.data());
    frame.download(image, back.data());
    stream_->synchronize();
    EXPECT_EQ(back, sent);
  }
}

TEST_P(MemoryGpuTest, AFrameKnowsItsImagesAlone) {
  const DeviceImage in(memory(), Element::kFloat, 4, 4);
  const DeviceImage out(memory(), Element::kFloat, 4, 4);
  const Frame frame({&in}, stream());
  EXPECT_EQ(frame.view(in).width, 4);
  EXPECT_THROW(frame.view(out), Error);
}

TEST_P(MemoryGpuTest, AFrameTakesAnImageThatIsNamedTwice) {
  const Image<float> sent = ramp(4, 4);
  Image<float> back(4, 4);
  const DeviceImage image(memory(), Element::kFloat, 4, 4);
  const DeviceImage other(memory(), Element::kFloat, 4, 4);
  const Frame frame({&image, &image, &other}, stream());
  frame.upload(image, sent.data());
  frame.upload(other, back.data());
  frame.download(image, back.data());
  stream_->synchronize();
  EXPECT_EQ(back, sent);
}

TEST_P(MemoryGpuTest, ThePoolGivesAnImageAgainOnceItIsBack) {
  ImagePool pool(memory());
  auto first = pool.take(Element::kFloat, 8, 8);
  const auto second = pool.take(Element::kFloat, 8, 8);
  EXPECT_NE(first.get(), second.get());
  const DeviceImage* address = first.get();
  first.reset();
  EXPECT_NE(pool.take(Element::kInt, 8, 8).get(), address);
  EXPECT_EQ(pool.take(Element::kFloat, 8, 8).get(), address);
}

TEST_P(SharedMemoryGpuTest, GlIsRefusedWhatCudaHasMapped) {
  const SharedTexture shared(Element::kFloat, 4, 4);
  EXPECT_NO_THROW(shared.texture());
  {
    const MappedTextures mapped({&shared}, stream());
    EXPECT_THROW(shared.texture(), Error);
    EXPECT_THROW(MappedTextures({&shared}, stream()), Error);
  }
  EXPECT_NO_THROW(shared.texture());
  EXPECT_THROW(MappedTextures({&shared, &shared}, stream()), Error);
  EXPECT_NO_THROW(shared.texture());
}

TEST_P(SharedMemoryGpuTest, AMappingKeepsItsTextureAlive) {
  auto shared = std::make_unique<SharedTexture>(Element::kFloat, 4, 4);
  const MappedTextures mapped({shared.get()}, stream());
  shared.reset();
  const Image<float> sent = ramp(4, 4);
  Image<float> back(4, 4);
  uploadTo(mapped.array(0), Element::kFloat, 4, 4, sent.data(), stream());
  downloadFrom(mapped.array(0), Element::kFloat, 4, 4, back.data(), stream());
  stream_->synchronize();
  EXPECT_EQ(back, sent);
}

TEST_P(MemoryGpuTest, AFailedCallNamesItselfOnce) {
  void* nowhere = nullptr;
  try {
    RP_CUDA(cudaMalloc(&nowhere, ~std::size_t{0} / 2));
    FAIL() << "that much memory there is not";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cudaMalloc"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("memory_gpu_test.cpp:"), std::string::npos);
  }
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
}

}  // namespace
}  // namespace rangepose::cuda
