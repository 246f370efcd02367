#include "io/camera_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/io_support.h"

namespace rangepose {
namespace {

using test::errorOf;
using test::expectTruncationsRefused;
using test::TempFolder;
using testing::AllOf;
using testing::HasSubstr;

const char* const kGood =
    R"({"cam_K": [500.5, 0, 319.5, 0, 501, 239, 0, 0, 1], "depth_scale": 0.1,
        "width": 640, "height": 480})";

std::string cameraError(const std::string& text) {
  return errorOf([&] { parseCamera(text, "camera file c.json"); });
}

TEST(CameraFile, ReadsAPinholeCamera) {
  const TempFolder folder;
  const Camera camera = readCamera(folder.write("c.json", kGood));
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.fx, 500.5);
  EXPECT_EQ(camera.fy, 501.0);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.0);
  EXPECT_EQ(camera.depth_scale, 0.1);
  EXPECT_FALSE(camera.orthographic);
}

TEST(CameraFile, SizeAndScaleMayBeMissing) {
  const Camera camera = parseCamera(R"({"cam_K": [500, 0, 9, 0, 500, 8, 0, 0, 1]})", "c");
  EXPECT_EQ(camera.width, 0);
  EXPECT_EQ(camera.height, 0);
  EXPECT_EQ(camera.depth_scale, 1.0);
}

TEST(CameraFile, TheErrorOfDepthIsMeasuredUnlessTheFileStatesIt) {
  const std::string matrix = R"({"cam_K": [500, 0, 9, 0, 500, 8, 0, 0, 1])";
  EXPECT_EQ(parseCamera(matrix + "}", "c").error_mm, 0.0);
  EXPECT_EQ(parseCamera(matrix + R"(, "error_mm": 1.25})", "c").error_mm, 1.25);
}

TEST(CameraFile, ReadsTheSeparateFieldsOfBop) {
  const Camera camera = parseCamera(
      R"({"cx": 325.26, "cy": 242.04, "depth_scale": 1.0, "fx": 572.4, "fy": 573.5,
          "height": 480, "width": 640})",
      "c");
  EXPECT_EQ(camera.fx, 572.4);
  EXPECT_EQ(camera.fy, 573.5);
  EXPECT_EQ(camera.cx, 325.26);
  EXPECT_EQ(camera.cy, 242.04);
}

TEST(CameraFile, OrthographicScanHasItsCentreInTheMiddle) {
  const Camera camera = parseCamera(
      R"({"orthographic": true, "pixel_size": 0.5, "width": 101, "height": 50,
          "depth_scale": 0.01})",
      "c");
  EXPECT_TRUE(camera.orthographic);
  EXPECT_EQ(camera.pixel_size_mm, 0.5);
  EXPECT_EQ(camera.cx, 50.0);
  EXPECT_EQ(camera.cy, 24.5);
  EXPECT_EQ(camera.depth_scale, 0.01);
}

TEST(CameraFile, OrthographicScanTakesAGivenCentre) {
  const Camera by_matrix = parseCamera(
      R"({"orthographic": true, "pixel_size": 1, "cam_K": [1, 0, 3, 0, 1, 4, 0, 0, 1]})", "c");
  EXPECT_EQ(by_matrix.cx, 3.0);
  EXPECT_EQ(by_matrix.cy, 4.0);
  const Camera by_name =
      parseCamera(R"({"orthographic": true, "pixel_size": 1, "cx": 5, "cy": 6})", "c");
  EXPECT_EQ(by_name.cx, 5.0);
  EXPECT_EQ(by_name.cy, 6.0);
}

TEST(CameraFile, OrthographicCentreWaitsForTheImage) {
  const Camera camera = parseCamera(R"({"orthographic": true, "pixel_size": 1})", "c");
  EXPECT_TRUE(std::isnan(camera.cx));
  const Camera sized = withImageSize(camera, 20, 10, "image");
  EXPECT_EQ(sized.cx, 9.5);
  EXPECT_EQ(sized.cy, 4.5);
}

TEST(CameraFile, ImageOfAnotherSizeIsAnError) {
  const Camera camera = parseCamera(kGood, "c");
  EXPECT_THAT(errorOf([&] { withImageSize(camera, 480, 640, "depth image d.png"); }),
              AllOf(HasSubstr("depth image d.png"), HasSubstr("480x640"), HasSubstr("640x480")));
}

struct BadCamera {
  const char* text;
  const char* field;
  const char* problem;
};

class BadCameraTest : public testing::TestWithParam<BadCamera> {};

TEST_P(BadCameraTest, IsRefusedWithFileAndField) {
  EXPECT_THAT(cameraError(GetParam().text),
              AllOf(HasSubstr("camera file c.json"),
                    HasSubstr(GetParam().field),
                    HasSubstr(GetParam().problem)));
}

INSTANTIATE_TEST_SUITE_P(
    CameraFile,
    BadCameraTest,
    testing::Values(
        BadCamera{"", "", "not valid JSON"},
        BadCamera{"[1, 2]", "", "JSON object"},
        BadCamera{"{\"cam_K\": [NaN, 0, 0, 0, 1, 0, 0, 0, 1]}", "", "not valid JSON"},
        BadCamera{"{}", "cam_K", "missing"},
        BadCamera{R"({"cam_K": "500"})", "cam_K", "array of 9"},
        BadCamera{R"({"cam_K": [1, 0, 0, 0, 1, 0, 0, 0]})", "cam_K", "array of 9"},
        BadCamera{R"({"cam_K": [1, 0, null, 0, 1, 0, 0, 0, 1]})", "cam_K", "entry 2"},
        BadCamera{R"({"cam_K": [1e999, 0, 0, 0, 1, 0, 0, 0, 1]})", "", "not valid JSON"},
        BadCamera{R"({"cam_K": [0, 0, 0, 0, 1, 0, 0, 0, 1]})", "cam_K", "singular"},
        BadCamera{R"({"cam_K": [1, 0, 0, 0, 0, 0, 0, 0, 1]})", "cam_K", "singular"},
        BadCamera{R"({"cam_K": [-1, 0, 0, 0, 1, 0, 0, 0, 1]})", "cam_K", "singular"},
        BadCamera{R"({"cam_K": [1, 0.2, 0, 0, 1, 0, 0, 0, 1]})", "cam_K", "skew"},
        BadCamera{R"({"cam_K": [1, 0, 0, 0.5, 1, 0, 0, 0, 1]})", "cam_K", "second row"},
        BadCamera{R"({"cam_K": [1, 0, 0, 0, 1, 0, 0, 0, 0]})", "cam_K", "last row"},
        BadCamera{R"({"cam_K": [1, 0, 0, 0, 1, 0, 9, 9, 1]})", "cam_K", "last row"},
        BadCamera{R"({"fx": 1, "fy": 1, "cx": 1})", "cy", "missing"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "depth_scale": 0})", "depth_scale", "positive"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "error_mm": 0})", "error_mm", "positive"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "depth_scale": "1"})", "depth_scale", "number"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "width": 640})", "height", "missing"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "width": 6.5, "height": 4})", "width", "whole"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "width": -6, "height": 4})", "width", "from 1"},
        BadCamera{R"({"cam_K": [1,0,0,0,1,0,0,0,1], "width": 60000, "height": 60000})",
                  "width",
                  "60000x60000"},
        BadCamera{R"({"orthographic": 1, "pixel_size": 1})", "orthographic", "true or false"},
        BadCamera{R"({"orthographic": true})", "pixel_size", "missing"},
        BadCamera{R"({"orthographic": true, "pixel_size": 0})", "pixel_size", "positive"}));

TEST(CameraFile, MissingEmptyFolderAndTruncatedFilesAreErrors) {
  const TempFolder folder;
  EXPECT_THAT(errorOf([&] { readCamera(folder.path() / "none.json"); }),
              AllOf(HasSubstr("none.json"), HasSubstr("no such file")));
  EXPECT_THAT(errorOf([&] { readCamera(folder.write("e.json", "")); }), HasSubstr("empty"));
  EXPECT_THAT(errorOf([&] { readCamera(folder.path()); }), HasSubstr("not a regular file"));
  expectTruncationsRefused(
      "c.json", kGood, std::string_view(kGood).size(), [](const auto& path) { readCamera(path); });
}

const char* const kBin =
    R"({"cam_R_bin2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_bin2c": [1, 2, 3],
        "inner_size": [40, 50, 6]})";

TEST(BinFile, ReadsRowByRow) {
  const TempFolder folder;
  const BinBox bin = readBinBox(folder.write("b.json", kBin));
  const glm::dvec3 moved = bin.camera_from_bin * glm::dvec3(10.0, 0.0, 0.0);
  EXPECT_EQ(moved, glm::dvec3(1.0, 12.0, 3.0));
  EXPECT_EQ(bin.inner_size_mm, glm::dvec3(40.0, 50.0, 6.0));
}

TEST(BinFile, BadFieldsAreNamed) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string text = kBin;
    text.replace(text.find(from), from.size(), to);
    return errorOf([&] { parseBinBox(text, "bin file b.json"); });
  };
  EXPECT_THAT(error("-1", "-2"), AllOf(HasSubstr("cam_R_bin2c"), HasSubstr("not a rotation")));
  EXPECT_THAT(error("-1", "1"), AllOf(HasSubstr("cam_R_bin2c"), HasSubstr("not a rotation")));
  EXPECT_THAT(error("cam_R_bin2c", "cam_R"), AllOf(HasSubstr("cam_R_bin2c"), HasSubstr("missing")));
  EXPECT_THAT(error("[1, 2, 3]", "[1, 2]"),
              AllOf(HasSubstr("cam_t_bin2c"), HasSubstr("3 numbers")));
  EXPECT_THAT(error("[40, 50, 6]", "[40, 0, 6]"),
              AllOf(HasSubstr("inner_size"), HasSubstr("positive")));
  EXPECT_THAT(error("[40, 50, 6]", "[40, 5, -6]"),
              AllOf(HasSubstr("inner_size"), HasSubstr("positive")));
}

}  // namespace
}  // namespace rangepose
