// Clouds in PLY files; those in PCD files are in pcd_test.cpp.
#include "io/cloud_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/io_support.h"

namespace rangepose {
namespace {

using test::errorOf;
using test::expectDamageSurvived;
using test::expectTruncationsRefused;
using test::rawBytes;
using test::TempFolder;
using testing::AllOf;
using testing::HasSubstr;

PointCloud readBytes(const std::string& bytes) {
  const TempFolder folder;
  return readCloud(folder.write("c.ply", bytes), LengthUnit::kMetre);
}

std::string errorFor(const std::string& bytes) {
  return errorOf([&] { readBytes(bytes); });
}

void readIt(const std::filesystem::path& path) { readCloud(path, LengthUnit::kMetre); }

const char* const kAscii =
    "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info num_rows 2\nelement vertex 6\n"
    "property float x\nproperty float y\nproperty float z\nproperty uchar red\nend_header\n"
    "0.1 0.2 0.5 255\n0 0 0 0\nnan nan nan 3\n1 2 3 4\n1 2 4 4\n1 2 5 4\n";

/// Six doubles and lists, with a camera element in front and a list behind.
std::string binary(bool big) {
  std::string bytes =
      std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\nelement camera 1\nproperty float view_px\nproperty list uchar int more\n"
      "element vertex 6\nproperty list uchar short extra\nproperty double x\n"
      "property double y\nproperty double z\nproperty int label\nend_header\n";
  bytes += rawBytes(1.5f, big) + "\x02" + rawBytes(7, big) + rawBytes(8, big);
  for (int i = 0; i < 6; ++i) {
    bytes += static_cast<char>(i);
    for (int k = 0; k < i; ++k) bytes += rawBytes(std::int16_t{-1}, big);
    bytes += rawBytes(0.25 * i, big) + rawBytes(-1.0 * i, big);
    bytes += rawBytes(i == 4 ? std::numeric_limits<double>::infinity() : 1.0 + i, big);
    bytes += rawBytes(i, big);
  }
  return bytes;
}

TEST(CloudPly, ReadsAsciiOrganised) {
  const PointCloud cloud = readBytes(kAscii);
  EXPECT_EQ(cloud.width, 3);
  EXPECT_EQ(cloud.height, 2);
  ASSERT_EQ(cloud.points_mm.size(), 6u);
  EXPECT_EQ(cloud.points_mm[0], glm::vec3(100.0f, 200.0f, 500.0f));
  EXPECT_EQ(cloud.points_mm[1], glm::vec3(0.0f));
  EXPECT_TRUE(std::isnan(cloud.points_mm[2].x));
  EXPECT_EQ(cloud.points_mm[5].z, 5000.0f);
}

TEST(CloudPly, GridThatDoesNotMatchIsUnorganised) {
  std::string text = kAscii;
  text.replace(text.find("num_rows 2"), 10, "num_rows 7");
  const PointCloud cloud = readBytes(text);
  EXPECT_EQ(cloud.width, 6);
  EXPECT_EQ(cloud.height, 1);
}

TEST(CloudPly, ReadsBinaryOfBothOrdersAndSkipsTheRest) {
  for (const bool big : {false, true}) {
    const PointCloud cloud = readBytes(binary(big));
    EXPECT_EQ(cloud.width, 6);
    EXPECT_EQ(cloud.height, 1);
    ASSERT_EQ(cloud.points_mm.size(), 6u);
    EXPECT_EQ(cloud.points_mm[3], glm::vec3(750.0f, -3000.0f, 4000.0f));
    EXPECT_TRUE(std::isinf(cloud.points_mm[4].z));
  }
}

TEST(CloudPly, MissingEmptyFolderAndWrongType) {
  const TempFolder folder;
  EXPECT_THAT(errorOf([&] { readIt(folder.path() / "none.ply"); }),
              AllOf(HasSubstr("none.ply"), HasSubstr("no such file")));
  EXPECT_THAT(errorOf([&] { readIt(folder.path()); }), HasSubstr("not a regular file"));
  EXPECT_THAT(errorFor(""), HasSubstr("the file is empty"));
  EXPECT_THAT(errorFor("\x89PNG\r\n\x1a\n"), HasSubstr("neither PLY nor PCD"));
  EXPECT_THAT(errorFor("plywood\n"), HasSubstr("not a PLY file"));
  EXPECT_THAT(
      errorFor("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n"),
      HasSubstr("no points"));
}

TEST(CloudPly, WrongNumbersAndListsAreErrors) {
  std::string text = kAscii;
  EXPECT_THAT(errorFor(text.replace(text.find("0.2"), 3, "0,2")),
              HasSubstr("\"0,2\" where a number is expected"));
  text = kAscii;
  EXPECT_THAT(errorFor(text.replace(text.find("float x"), 7, "list uchar float x")),
              HasSubstr("no number x"));
  std::string lists = binary(false);
  lists.replace(lists.find("uchar short"), 11, "char short");
  lists[lists.find("end_header\n") + 11 + 4 + 9] = '\xfe';
  EXPECT_THAT(errorFor(lists), HasSubstr("list \"extra\" of length -2"));
}

TEST(CloudPly, AbsurdCountsAreRefusedBeforeMemoryIsTaken) {
  for (const std::string& whole : {std::string(kAscii), binary(true)}) {
    std::string bytes = whole;
    bytes.replace(bytes.find("vertex 6"), 8, "vertex 9000000000000000000");
    EXPECT_THAT(errorFor(bytes), AllOf(HasSubstr("truncated"), HasSubstr("9000000000000000000")));
  }
}

TEST(CloudPly, TruncatedFilesAreErrors) {
  for (const bool big : {false, true}) {
    const std::string bytes = binary(big);
    expectTruncationsRefused("c.ply", bytes, bytes.size() - 4, readIt);
  }
  const std::string ascii = kAscii;
  expectTruncationsRefused("c.ply", ascii, ascii.size() - 3, readIt);
}

TEST(CloudPly, ChangedBytesNeverCrash) {
  expectDamageSurvived("c.ply", kAscii, readIt);
  expectDamageSurvived("c.ply", binary(false), readIt);
}

}  // namespace
}  // namespace rangepose
