#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "io/cloud_file.h"
#include "io/io_support.h"
#include "io/lzf.h"

namespace rangepose {
namespace {

using test::errorOf;
using test::expectDamageSurvived;
using test::expectTruncationsRefused;
using test::rawBytes;
using test::TempFolder;
using testing::AllOf;
using testing::HasSubstr;

std::string fromHex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// liblzf 3.6 made this of the 640 bytes of the fields x, y, z, w of 40 points (8 columns, 5 rows):
/// x = 0.5 * column, y = -0.25 * row, z = 2, w = 0, as floats, field by field.
const std::string kPackedByLiblzf = fromHex(
    "0100006000033f000080200300c020030400400000202003004020030060200360002017e0701f00802081e0"
    "12030180bee015030100bfe015030040201fe013030080201fe01303412fe09403e09200010000");

std::array<float, 4> packedPoint(int i) {
  const int row = i / 8;
  return {0.5f * static_cast<float>(i % 8), -0.25f * static_cast<float>(row), 2.0f, 0.0f};
}

PointCloud readBytes(const std::string& bytes, LengthUnit unit = LengthUnit::kMetre) {
  const TempFolder folder;
  return readCloud(folder.write("c.pcd", bytes), unit);
}

std::string errorFor(const std::string& bytes) {
  return errorOf([&] { readBytes(bytes); });
}

void readIt(const std::filesystem::path& path) { readCloud(path, LengthUnit::kMetre); }

std::string compressedFile() {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z w\nSIZE 4 4 4 4\n"
         "TYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 8\nHEIGHT 5\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 40\n"
         "DATA binary_compressed\n" +
         rawBytes(static_cast<std::uint32_t>(kPackedByLiblzf.size())) + rawBytes(640u) +
         kPackedByLiblzf;
}

const char* const kAscii =
    "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
    "COUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n"
    "0.001 0.002 0.5\nnan nan nan\n-1e-3 +2 0.25\n";

/// One file with the fields mixed with others of all sizes, ordered z, normal, y, rgb, x.
std::string mixedBinary() {
  std::string bytes =
      "VERSION 0.7\nFIELDS z normal y rgb x\nSIZE 4 4 8 1 4\nTYPE F F F U F\nCOUNT 1 3 1 3 1\n"
      "WIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA binary\n";
  for (int i = 0; i < 4; ++i) {
    const auto value = static_cast<float>(i);
    bytes += rawBytes(1.0f + value);
    bytes += rawBytes(9.0f) + rawBytes(9.0f) + rawBytes(9.0f);
    bytes += rawBytes(double{10.0 + i});
    bytes += "rgb";
    bytes += rawBytes(20.0f + value);
  }
  return bytes;
}

TEST(Lzf, ExpandsWhatLiblzfPacked) {
  const std::string raw = expandLzf(kPackedByLiblzf, 640, "data");
  for (int field = 0; field < 4; ++field) {
    for (int i = 0; i < 40; ++i) {
      const std::string expected = rawBytes(packedPoint(i)[static_cast<std::size_t>(field)]);
      EXPECT_EQ(raw.substr(static_cast<std::size_t>(field * 160 + i * 4), 4), expected);
    }
  }
}

TEST(Lzf, ExpandsLiteralsAndOverlappingCopies) {
  EXPECT_EQ(expandLzf(std::string("\x02"
                                  "abc",
                                  4),
                      3,
                      "data"),
            "abc");
  // 'a', then a copy of 3 + 2 bytes from one byte back, then a copy of 7 + 1 + 2 from two bytes
  // back.
  EXPECT_EQ(expandLzf(std::string("\x00"
                                  "a\x60\x00",
                                  4),
                      6,
                      "data"),
            "aaaaaa");
  EXPECT_EQ(expandLzf(std::string("\x01"
                                  "ab\xe0\x01\x01",
                                  6),
                      12,
                      "data"),
            "abababababab");
}

TEST(Lzf, DamageIsAnError) {
  const auto error = [](const std::string& packed, std::size_t size) {
    return errorOf([&] { expandLzf(packed, size, "data"); });
  };
  EXPECT_THAT(error(std::string("\x00"
                                "a\x60",
                                3),
                    6),
              HasSubstr("damaged or truncated"));
  EXPECT_THAT(error(std::string("\x00"
                                "a\x60\x01",
                                4),
                    6),
              HasSubstr("damaged"));  // before the start
  EXPECT_THAT(error(std::string("\x02"
                                "ab",
                                3),
                    3),
              HasSubstr("damaged"));
  EXPECT_THAT(error(std::string("\x02"
                                "abc",
                                4),
                    2),
              HasSubstr("damaged"));
  EXPECT_THAT(error(std::string("\x02"
                                "abc",
                                4),
                    4),
              HasSubstr("damaged"));
  for (std::size_t length = 0; length < kPackedByLiblzf.size(); ++length) {
    EXPECT_NE(error(kPackedByLiblzf.substr(0, length), 640), "") << length;
  }
}

TEST(Pcd, ReadsCompressed) {
  const PointCloud cloud = readBytes(compressedFile());
  EXPECT_EQ(cloud.width, 8);
  EXPECT_EQ(cloud.height, 5);
  ASSERT_EQ(cloud.points_mm.size(), 40u);
  for (int i = 0; i < 40; ++i) {
    const std::array<float, 4> point = packedPoint(i);
    EXPECT_EQ(cloud.points_mm[static_cast<std::size_t>(i)],
              1000.0f * glm::vec3(point[0], point[1], point[2]));
  }
}

TEST(Pcd, ReadsAsciiAndKeepsNan) {
  const PointCloud cloud = readBytes(kAscii);
  EXPECT_EQ(cloud.width, 3);
  EXPECT_EQ(cloud.height, 1);
  ASSERT_EQ(cloud.points_mm.size(), 3u);
  EXPECT_EQ(cloud.points_mm[0], glm::vec3(1.0f, 2.0f, 500.0f));
  EXPECT_TRUE(std::isnan(cloud.points_mm[1].z));
  EXPECT_EQ(cloud.points_mm[2], glm::vec3(-1.0f, 2000.0f, 250.0f));
  EXPECT_EQ(readBytes(kAscii, LengthUnit::kMillimetre).points_mm[0].z, 0.5f);
}

TEST(Pcd, ReadsBinaryWithAnyOrderSizeAndCount) {
  const PointCloud cloud = readBytes(mixedBinary());
  EXPECT_EQ(cloud.width, 2);
  EXPECT_EQ(cloud.height, 2);
  ASSERT_EQ(cloud.points_mm.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const auto value = static_cast<float>(i);
    EXPECT_EQ(cloud.points_mm[static_cast<std::size_t>(i)],
              1000.0f * glm::vec3(20.0f + value, 10.0f + value, 1.0f + value));
  }
}

TEST(Pcd, ReadsAsciiWithOtherFieldsBetween) {
  const PointCloud cloud = readBytes(
      "VERSION 0.7\nFIELDS n x _ y z\nSIZE 4 4 1 8 4\nTYPE F F U F F\nCOUNT 2 1 1 1 1\nWIDTH "
      "1\nHEIGHT 1\n"
      "POINTS 1\nDATA ascii\n7 8 1 label 2 3");
  EXPECT_EQ(cloud.points_mm.at(0), glm::vec3(1000.0f, 2000.0f, 3000.0f));
}

TEST(Pcd, CountMayBeMissing) {
  std::string text = kAscii;
  text.replace(text.find("COUNT 1 1 1\n"), 12, "");
  EXPECT_EQ(readBytes(text).points_mm.size(), 3u);
}

struct BadPcd {
  const char* from;
  const char* to;
  const char* problem;
};

class BadPcdTest : public testing::TestWithParam<BadPcd> {};

TEST_P(BadPcdTest, IsRefused) {
  std::string text = kAscii;
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  EXPECT_THAT(errorFor(text), AllOf(HasSubstr("c.pcd"), HasSubstr(GetParam().problem)));
}

INSTANTIATE_TEST_SUITE_P(
    Pcd,
    BadPcdTest,
    testing::Values(BadPcd{"FIELDS x y z", "FIELDS x y d", "no field z"},
                    BadPcd{"FIELDS x y z", "FIELDS x y", "3 values in SIZE for 2 FIELDS"},
                    BadPcd{"SIZE 4 4 4", "SIZE 4 4 3", "SIZE other than"},
                    BadPcd{"SIZE 4 4 4", "SIZE 4 4 2", "not one float"},
                    BadPcd{"TYPE F F F", "TYPE F F U", "not one float"},
                    BadPcd{"TYPE F F F", "TYPE F F Q", "TYPE other than"},
                    BadPcd{"COUNT 1 1 1", "COUNT 1 1 2", "not one float"},
                    BadPcd{"COUNT 1 1 1", "COUNT 1 1 -1", "bad COUNT"},
                    BadPcd{"WIDTH 3", "WIDTH three", "WIDTH that is no whole number"},
                    BadPcd{"WIDTH 3", "WIDTH 0", "WIDTH 0"},
                    BadPcd{"WIDTH 3", "WIDTH 4", "POINTS 3, but WIDTH x HEIGHT is 4"},
                    BadPcd{"HEIGHT 1", "HEIGHT 9000000000000", "points are supported"},
                    BadPcd{"WIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3",
                           "WIDTH 99999999\nHEIGHT 1\nPOINTS 99999999",
                           "truncated"},
                    BadPcd{"POINTS 3", "POINTS 5", "POINTS 5"},
                    BadPcd{"DATA ascii", "DATA zip", "DATA other than"},
                    BadPcd{"DATA ascii\n", "", "not understood"},
                    BadPcd{"0.002", "two", "where a number is expected"}));

TEST(Pcd, AbsurdCompressedSizesAreRefusedBeforeMemoryIsTaken) {
  std::string bytes = compressedFile();
  bytes.replace(bytes.find("WIDTH 8"), 7, "WIDTH 20000000");
  bytes.replace(bytes.find("POINTS 40"), 9, "POINTS 100000000");
  const std::size_t at = bytes.find("compressed\n") + 11 + 4;
  bytes.replace(at, 4, rawBytes(1600000000u));
  EXPECT_THAT(errorFor(bytes), HasSubstr("1600000000 bytes for 100000000 points"));
}

TEST(Pcd, CompressedSizeThatDoesNotMatchThePointsIsRefused) {
  std::string bytes = compressedFile();
  bytes.replace(bytes.find("SIZE 4 4 4 4"), 12, "SIZE 4 4 4 8");
  EXPECT_THAT(errorFor(bytes), HasSubstr("640 bytes for 40 points of 20"));
}

TEST(Pcd, TruncatedFilesAreErrors) {
  const std::string compressed = compressedFile();
  expectTruncationsRefused("c.pcd", compressed, compressed.size(), readIt);
  const std::string binary = mixedBinary();
  expectTruncationsRefused("c.pcd", binary, binary.size(), readIt);
  const std::string ascii = kAscii;
  // Digits behind the point of the last number can be lost without a trace.
  expectTruncationsRefused("c.pcd", ascii, ascii.size() - 4, readIt);
}

TEST(Pcd, ChangedBytesNeverCrash) {
  expectDamageSurvived("c.pcd", compressedFile(), readIt);
  expectDamageSurvived("c.pcd", mixedBinary(), readIt);
  expectDamageSurvived("c.pcd", kAscii, readIt);
}

}  // namespace
}  // namespace rangepose
