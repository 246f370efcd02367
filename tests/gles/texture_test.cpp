#include "gles/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "gles/framebuffer.h"
#include "support/backends.h"

namespace rangepose::gles {
namespace {

using TextureTest = test::GlesFixture;

constexpr float kValues[] = {0.0f, -0.0f, 1.0f / 3.0f, -16777215.0f, 1.0e-30f, 3.0e38f, 65504.5f};

TEST_F(TextureTest, FloatsComeBackBitByBit) {
  Image<float> image(33, 17);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.data()[i] = kValues[i % std::size(kValues)] + static_cast<float>(i % 5);
  }
  EXPECT_EQ(Texture(image).downloadFloats(), image);
}

TEST_F(TextureTest, VectorsComeBackBitByBitAndNotFlipped) {
  Image<glm::vec4> image(5, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x)
      image.at(x, y) = glm::vec4(x, y, 0.1f * static_cast<float>(x), -1.0f);
  }
  EXPECT_EQ(downloadVectors(Texture(image)), image);
}

TEST_F(TextureTest, PartsOfRowsComeBack) {
  Image<glm::vec4> image(4, 6);
  for (int y = 0; y < 6; ++y) image.at(2, y) = glm::vec4(static_cast<float>(y));
  std::vector<glm::vec4> rows(8, glm::vec4(-7.0f));
  Texture(image).downloadRgba(3, 2, &rows[0].x);
  EXPECT_EQ(rows[2], glm::vec4(3.0f));
  EXPECT_EQ(rows[6], glm::vec4(4.0f));
  EXPECT_EQ(rows[0], glm::vec4(0.0f));
}

TEST_F(TextureTest, IntegersComeBack) {
  Image<std::int32_t> image(7, 5);
  for (int i = 0; i < 35; ++i) image.data()[i] = i * 123457 - 1;
  image.at(6, 4) = std::numeric_limits<std::int32_t>::min();
  Texture texture(Format::kR32i, 7, 5);
  texture.upload(image.data());
  EXPECT_EQ(texture.downloadInts(), image);
}

TEST_F(TextureTest, ClearReachesEveryTexel) {
  const Canvas canvas(Format::kRgba32f, 9, 4);
  const glm::vec4 value(1.25f, -2.0f, 1.0e6f, 0.1f);
  canvas.framebuffer.clear(value);
  EXPECT_EQ(downloadVectors(canvas.texture), Image<glm::vec4>(9, 4, value));
}

TEST_F(TextureTest, ImpossibleSizesAreRefused) {
  EXPECT_THROW(Texture(Format::kR32f, 0, 4), Error);
  EXPECT_THROW(Texture(Format::kR32f, context().info().max_texture_size + 1, 4), Error);
}

TEST_F(TextureTest, TheWrongFormatIsRefused) {
  const Texture texture(Format::kR32f, 2, 2);
  float value[4] = {};
  EXPECT_THROW(texture.downloadRgba(0, 1, value), Error);
  EXPECT_THROW(texture.downloadInts(), Error);
  EXPECT_THROW(Texture(Format::kRgba32f, 2, 2).downloadRgba(1, 2, value), Error);
}

}  // namespace
}  // namespace rangepose::gles
