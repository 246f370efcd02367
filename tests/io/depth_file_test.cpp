#include "io/depth_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "io/camera_file.h"
#include "io/image_writers.h"
#include "io/io_support.h"

namespace rangepose {
namespace {

using test::errorOf;
using test::makeExr;
using test::makePng;
using test::makeTiff;
using test::TempFolder;
using test::TiffLayout;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kWidth = 23;
constexpr int kHeight = 19;

Camera camera(double depth_scale) {
  Camera result = parseCamera(R"({"cam_K": [100, 0, 11, 0, 100, 9, 0, 0, 1]})", "c");
  result.depth_scale = depth_scale;
  return result;
}

std::vector<float> ramp() {
  std::vector<float> values;
  values.reserve(kWidth * kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i) values.push_back(static_cast<float>(i * 149 % 65536));
  return values;
}

void expectRamp(const DepthImage& image, double depth_scale) {
  ASSERT_EQ(image.depth_mm.width(), kWidth);
  ASSERT_EQ(image.depth_mm.height(), kHeight);
  EXPECT_EQ(image.camera.width, kWidth);
  EXPECT_EQ(image.camera.height, kHeight);
  const std::vector<float> values = ramp();
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_FLOAT_EQ(image.depth_mm.data()[i], static_cast<float>(values[i] * depth_scale)) << i;
  }
}

TEST(DepthFile, ReadsPng) {
  const TempFolder folder;
  const std::vector<float> values = ramp();
  const std::vector<std::uint16_t> words(values.begin(), values.end());
  const auto path = folder.write("d.png", makePng(kWidth, kHeight, 1, 16, words));
  expectRamp(readDepth(path, camera(0.1)), 0.1);
}

TEST(DepthFile, ReadsTiffInAllLayouts) {
  const TempFolder folder;
  for (const bool is_float : {false, true}) {
    for (const bool tiled : {false, true}) {
      for (const bool compressed : {false, true}) {
        for (const bool big_endian : {false, true}) {
          const TiffLayout layout{1, is_float ? 32 : 16, is_float, tiled, compressed, big_endian};
          const auto path = folder.write("d.tif", makeTiff(kWidth, kHeight, layout, ramp()));
          SCOPED_TRACE(testing::Message() << is_float << tiled << compressed << big_endian);
          expectRamp(readDepth(path, camera(2.0)), 2.0);
        }
      }
    }
  }
}

TEST(DepthFile, ReadsExrByChannel) {
  const TempFolder folder;
  for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
           {"Y"}, {"Z"}, {"any"}, {"R", "G", "B", "Z"}, {"A.Depth", "Y"}}) {
    const auto path = folder.write("d.exr", makeExr(kWidth, kHeight, names, ramp()));
    expectRamp(readDepth(path, camera(1.0)), 1.0);
  }
}

TEST(DepthFile, ReadsHalfFloatExr) {
  const TempFolder folder;
  std::vector<float> values(kWidth * kHeight, 512.0f);
  const auto path = folder.write("d.exr", makeExr(kWidth, kHeight, {"Z"}, values, true));
  EXPECT_EQ(readDepth(path, camera(1.0)).depth_mm.at(3, 4), 512.0f);
}

TEST(DepthFile, ContentDecidesAndNotTheName) {
  const TempFolder folder;
  const auto path = folder.write("d.png", makeTiff(kWidth, kHeight, TiffLayout{}, ramp()));
  expectRamp(readDepth(path, camera(1.0)), 1.0);
}

TEST(DepthFile, NanInfiniteAndNegativeValuesAreNoMeasurement) {
  const TempFolder folder;
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const std::vector<float> values{
      std::numeric_limits<float>::quiet_NaN(), kInf, -kInf, -3.0f, 0.0f, -0.0f, 7.5f, 3e38f};
  for (const std::string& bytes :
       {makeTiff(8, 1, TiffLayout{1, 32, true}, values), makeExr(8, 1, {"Z"}, values)}) {
    const DepthImage image = readDepth(folder.write("d", bytes), camera(10.0));
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(image.depth_mm.at(x, 0), x == 6 ? 75.0f : 0.0f) << x;
    }
    EXPECT_EQ(validPixels(image), 1);
  }
}

TEST(DepthFile, AllZeroIsReadAndHasNoValidPixel) {
  const TempFolder folder;
  const auto path =
      folder.write("d.png", makePng(4, 3, 1, 16, std::vector<std::uint16_t>(12, std::uint16_t{0})));
  EXPECT_EQ(validPixels(readDepth(path, camera(1.0))), 0);
}

TEST(DepthFile, ImageOfAnotherSizeThanTheCameraIsAnError) {
  const TempFolder folder;
  const auto path = folder.write("d.tif", makeTiff(kWidth, kHeight, TiffLayout{}, ramp()));
  Camera other = camera(1.0);
  other.width = 640;
  other.height = 480;
  EXPECT_THAT(errorOf([&] { readDepth(path, other); }),
              AllOf(HasSubstr("d.tif"), HasSubstr("23x19"), HasSubstr("640x480")));
}

TEST(DepthFile, WrittenPngIsReadBack) {
  const TempFolder folder;
  DepthImage image;
  image.camera = camera(0.25);
  image.camera.width = 31;
  image.camera.height = 7;
  image.depth_mm = Image<float>(31, 7);
  for (int i = 0; i < 31 * 7; ++i) image.depth_mm.data()[i] = 0.25f * static_cast<float>(i * 300);
  const auto path = folder.path() / "d.png";
  writeDepthPng(path, image);
  EXPECT_EQ(readDepth(path, image.camera).depth_mm, image.depth_mm);
}

TEST(DepthFile, WritingRoundsAndRefusesWhatDoesNotFit) {
  const TempFolder folder;
  DepthImage image{camera(10.0), Image<float>(2, 1)};
  image.depth_mm.at(0, 0) = 14.9f;
  image.depth_mm.at(1, 0) = 15.1f;
  writeDepthPng(folder.path() / "d.png", image);
  const DepthImage read = readDepth(folder.path() / "d.png", image.camera);
  EXPECT_EQ(read.depth_mm.at(0, 0), 10.0f);
  EXPECT_EQ(read.depth_mm.at(1, 0), 20.0f);

  image.depth_mm.at(1, 0) = 655356.0f;
  EXPECT_THAT(errorOf([&] { writeDepthPng(folder.path() / "e.png", image); }),
              AllOf(HasSubstr("(1, 0)"), HasSubstr("does not fit into 16 bits")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "e.png"));
}

}  // namespace
}  // namespace rangepose
