// Depth images that must be refused, by one line and without a word on stdout or stderr.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "io/camera_file.h"
#include "io/depth_file.h"
#include "io/image_writers.h"
#include "io/io_support.h"

namespace rangepose {
namespace {

using test::errorOf;
using test::expectDamageSurvived;
using test::expectTruncationsRefused;
using test::makeExr;
using test::makePng;
using test::makeTiff;
using test::rawBytes;
using test::TempFolder;
using test::TiffLayout;
using testing::AllOf;
using testing::HasSubstr;

const Camera kCamera = parseCamera(R"({"cam_K": [9, 0, 1, 0, 9, 1, 0, 0, 1]})", "c");

void readIt(const std::filesystem::path& path) { readDepth(path, kCamera); }

std::string errorFor(const std::string& bytes) {
  const TempFolder folder;
  return errorOf([&] { readIt(folder.write("d.img", bytes)); });
}

std::vector<float> noise(int count) {
  std::vector<float> values;
  unsigned state = 1;
  for (int i = 0; i < count; ++i) {
    state = state * 1664525u + 1013904223u;
    values.push_back(static_cast<float>(state >> 16));
  }
  return values;
}

std::string noisePng(int width, int height) {
  const std::vector<float> values = noise(width * height);
  return makePng(width, height, 1, 16, {values.begin(), values.end()});
}

TEST(DepthDamage, MissingEmptyAndFolder) {
  const TempFolder folder;
  EXPECT_THAT(errorOf([&] { readIt(folder.path() / "none.png"); }),
              AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
  EXPECT_THAT(errorOf([&] { readIt(folder.path()); }), HasSubstr("not a regular file"));
  EXPECT_THAT(errorFor(""), HasSubstr("empty"));
}

TEST(DepthDamage, WrongTypes) {
  EXPECT_THAT(errorFor("solid part\n"), HasSubstr("neither PNG, TIFF nor EXR"));
  EXPECT_THAT(errorFor("\xff\xd8\xff\xe0 a JPEG"), HasSubstr("neither PNG, TIFF nor EXR"));
}

TEST(DepthDamage, EightBitPng) {
  EXPECT_THAT(errorFor(makePng(2, 2, 1, 8, {1, 2, 3, 4})), HasSubstr("depth needs 16 bits"));
}

TEST(DepthDamage, ColourImages) {
  const std::vector<std::uint16_t> rgb(12, std::uint16_t{5});
  EXPECT_THAT(errorFor(makePng(2, 2, 3, 16, rgb)), HasSubstr("colour PNG"));
  EXPECT_THAT(errorFor(makePng(2, 2, 3, 8, rgb)), HasSubstr("colour PNG"));
  EXPECT_THAT(errorFor(makeTiff(2, 2, TiffLayout{3}, std::vector<float>(12, 5.0f))),
              HasSubstr("colour TIFF"));
  EXPECT_THAT(errorFor(makeExr(2, 2, {"R", "G", "B"}, {1, 2, 3, 4})),
              AllOf(HasSubstr("no depth among the EXR channels"), HasSubstr("B, G, R")));
}

TEST(DepthDamage, OtherTiffSamples) {
  EXPECT_THAT(errorFor(makeTiff(2, 2, TiffLayout{1, 8}, {1, 2, 3, 4})), HasSubstr("8-bit"));
  EXPECT_THAT(errorFor(makeTiff(2, 2, TiffLayout{1, 64, true}, {1, 2, 3, 4})), HasSubstr("64-bit"));
}

/// The checksum of PNG chunks, bit by bit.
std::uint32_t crc32Of(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// The size fields of a good file are overwritten: nothing of that size may be taken as memory.
TEST(DepthDamage, OversizedPng) {
  std::string png = noisePng(37, 29);
  const std::size_t type_at = png.find("IHDR");
  ASSERT_EQ(type_at, 12u);
  png.replace(16, 8, rawBytes(100000u, true) + rawBytes(1000u, true));
  png.replace(29, 4, rawBytes(crc32Of(std::string_view(png).substr(type_at, 17)), true));
  EXPECT_THAT(errorFor(png), AllOf(HasSubstr("100000x1000"), HasSubstr("not supported")));
}

TEST(DepthDamage, OversizedTiff) {
  std::string tiff = makeTiff(300, 200, TiffLayout{}, noise(60000));
  for (const std::uint32_t size : {300u, 200u}) {
    // An entry: tag 256 or 257, type 3 (short), count 1, value.
    const auto tag = static_cast<std::uint16_t>(size == 300 ? 256 : 257);
    const std::string entry =
        rawBytes(tag) + rawBytes(std::uint16_t{3}) + rawBytes(1u) + rawBytes(size);
    const std::size_t at = tiff.find(entry);
    ASSERT_NE(at, std::string::npos);
    tiff.replace(at + 2, 10, rawBytes(std::uint16_t{4}) + rawBytes(1u) + rawBytes(60000u));
  }
  EXPECT_THAT(errorFor(tiff), AllOf(HasSubstr("60000x60000"), HasSubstr("not supported")));
}

TEST(DepthDamage, OversizedExr) {
  std::string exr = makeExr(300, 200, {"Z"}, noise(60000));
  const std::string window = rawBytes(0) + rawBytes(0) + rawBytes(299) + rawBytes(199);
  for (int copies = 0; copies < 2; ++copies) {  // dataWindow and displayWindow
    const std::size_t at = exr.find(window);
    ASSERT_NE(at, std::string::npos);
    exr.replace(at + 8, 8, rawBytes(2000000000) + rawBytes(2000000000));
  }
  EXPECT_THAT(errorFor(exr), AllOf(HasSubstr("2000000001x2000000001"), HasSubstr("not supported")));
}

TEST(DepthDamage, TruncatedPng) {
  const std::string png = noisePng(37, 29);
  expectTruncationsRefused("d.png", png, png.size(), readIt);
}

TEST(DepthDamage, TruncatedTiff) {
  // libtiff writes the directory behind the pixels: every beginning lacks a part of it. The last
  // bytes can be values of tags that nobody needs.
  for (const TiffLayout& layout : {TiffLayout{}, TiffLayout{1, 32, true, true, true}}) {
    const std::string tiff = makeTiff(37, 29, layout, noise(37 * 29));
    expectTruncationsRefused("d.tif", tiff, tiff.size() / 2, readIt);
  }
}

TEST(DepthDamage, TruncatedExr) {
  const std::string exr = makeExr(37, 29, {"Z"}, noise(37 * 29));
  expectTruncationsRefused("d.exr", exr, exr.size(), readIt);
}

TEST(DepthDamage, ChangedBytesNeverCrash) {
  expectDamageSurvived("d.png", noisePng(37, 29), readIt);
  for (const bool tiled : {false, true}) {
    for (const bool compressed : {false, true}) {
      const TiffLayout layout{1, 32, true, tiled, compressed};
      expectDamageSurvived("d.tif", makeTiff(37, 29, layout, noise(37 * 29)), readIt);
    }
  }
  expectDamageSurvived("d.exr", makeExr(37, 29, {"Z"}, noise(37 * 29)), readIt);
}

}  // namespace
}  // namespace rangepose
