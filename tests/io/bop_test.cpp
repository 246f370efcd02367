#include "io/bop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "io/depth_file.h"
#include "io/image_writers.h"
#include "io/io_support.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::errorOf;
using test::makePng;
using test::makeTiff;
using test::TempFolder;
using test::TiffLayout;
using testing::AllOf;
using testing::HasSubstr;

const char* const kCameras =
    R"({"0": {"cam_K": [500, 0, 1, 0, 500, 1, 0, 0, 1], "depth_scale": 0.1},
        "12": {"cam_K": [510, 0, 1, 0, 510, 1, 0, 0, 1], "depth_scale": 0.2, "cam_R_w2c": [1]}})";
const char* const kInfos =
    R"({"1": {"diameter": 102.5, "symmetries_discrete":
               [[-1, 0, 0, 3, 0, -1, 0, 4, 0, 0, 1, 5, 0, 0, 0, 1]],
             "symmetries_continuous": [{"axis": [0, 0, 2], "offset": [1, 2, 3]}]},
        "30": {"diameter": 50, "min_x": -1}})";

/// Two models, scene 3 with images 0 (PNG, in a bin) and 12 (TIFF), and scene 20 without images on
/// disk.
class BopFolder : public TempFolder {
 public:
  BopFolder() {
    const std::vector<std::uint16_t> values(6, std::uint16_t{1000});
    write("models/obj_000030.ply", "ply");
    write("models/obj_000001.ply", "ply");
    write("models/readme.txt", "no model");
    write("models/models_info.json", kInfos);
    write("test/000003/scene_camera.json", kCameras);
    write("test/000003/depth/000000.png", makePng(3, 2, 1, 16, values));
    write("test/000003/depth/000012.tif",
          makeTiff(3, 2, TiffLayout{}, std::vector<float>(6, 1000.0f)));
    write("test/000003/scene_bin.json",
          R"({"0": {"cam_R_bin2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_bin2c": [0, 0, 700],
                    "inner_size": [300, 200, 100]}})");
    write("test/000020/scene_camera.json", kCameras);
    write("test/notes/scene_camera.json", kCameras);
  }
};

TEST(Bop, ReadsModelsWithSymmetries) {
  const BopFolder folder;
  const BopDataset data = openBop(folder.path());
  ASSERT_EQ(data.models.size(), 2u);
  EXPECT_EQ(data.models[0].obj_id, 1);
  EXPECT_EQ(data.models[1].obj_id, 30);
  EXPECT_EQ(data.models[1].mesh_path.filename(), "obj_000030.ply");
  ASSERT_TRUE(data.models[0].info && data.models[1].info);
  const BopModelInfo& info = *data.models[0].info;
  EXPECT_EQ(info.diameter_mm, 102.5);
  ASSERT_EQ(info.symmetries_discrete.size(), 1u);
  EXPECT_EQ(info.symmetries_discrete[0] * glm::dvec3(1.0, 2.0, 3.0), glm::dvec3(2.0, 2.0, 8.0));
  ASSERT_EQ(info.symmetries_continuous.size(), 1u);
  EXPECT_EQ(info.symmetries_continuous[0].axis, glm::dvec3(0.0, 0.0, 1.0));
  EXPECT_EQ(info.symmetries_continuous[0].offset_mm, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_TRUE(data.models[1].info->symmetries_discrete.empty());
}

TEST(Bop, ReadsScenesImagesCamerasAndBins) {
  const BopFolder folder;
  const BopDataset data = openBop(folder.path());
  ASSERT_EQ(data.scenes.size(), 2u);
  EXPECT_EQ(data.scenes[0].scene_id, 3);
  EXPECT_EQ(data.scenes[1].scene_id, 20);
  EXPECT_TRUE(data.scenes[1].images.empty());
  const std::vector<BopImage>& images = data.scenes[0].images;
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].im_id, 0);
  EXPECT_EQ(images[1].im_id, 12);
  EXPECT_EQ(images[1].camera.fx, 510.0);
  ASSERT_TRUE(images[0].bin.has_value());
  EXPECT_EQ(images[0].bin->inner_size_mm, glm::dvec3(300.0, 200.0, 100.0));
  EXPECT_FALSE(images[1].bin.has_value());
  const DepthImage png = readDepth(images[0].depth_path, images[0].camera);
  const DepthImage tiff = readDepth(images[1].depth_path, images[1].camera);
  EXPECT_EQ(png.camera.width, 3);
  EXPECT_FLOAT_EQ(png.depth_mm.at(2, 1), 100.0f);
  EXPECT_FLOAT_EQ(tiff.depth_mm.at(2, 1), 200.0f);
}

TEST(Bop, TargetsSelectImages) {
  const BopFolder folder;
  folder.write("test_targets_bop19.json",
               R"([{"im_id": 12, "inst_count": 2, "obj_id": 1, "scene_id": 3},
                   {"im_id": 12, "inst_count": 1, "obj_id": 30, "scene_id": 3}])");
  const BopDataset data = openBop(folder.path());
  EXPECT_EQ(data.targets.size(), 2u);
  ASSERT_EQ(data.scenes[0].images.size(), 1u);
  const BopImage& image = data.scenes[0].images[0];
  EXPECT_EQ(image.im_id, 12);
  ASSERT_EQ(image.targets.size(), 2u);
  EXPECT_EQ(image.targets[0].inst_count, 2);
  EXPECT_EQ(image.targets[1].obj_id, 30);
}

TEST(Bop, TargetWithoutItsDepthImageIsAnError) {
  const BopFolder folder;
  folder.write("test_targets_bop19.json", R"([{"im_id": 12, "obj_id": 1, "scene_id": 20}])");
  EXPECT_THAT(errorOf([&] { openBop(folder.path()); }),
              AllOf(HasSubstr("000020"), HasSubstr("no depth image for image 12")));
}

TEST(Bop, OtherSplitsAndAFolderOfScenes) {
  const BopFolder folder;
  fs::rename(folder.path() / "test", folder.path() / "train_pbr");
  EXPECT_TRUE(openBop(folder.path()).scenes.empty());
  EXPECT_EQ(openBop(folder.path(), "train_pbr").scenes.size(), 2u);
  const BopDataset data = openBop(folder.path() / "train_pbr");
  EXPECT_EQ(data.scenes.size(), 2u);
  EXPECT_EQ(data.models.size(), 2u);
}

TEST(Bop, MissingAndEmptyFoldersAreErrors) {
  const TempFolder folder;
  EXPECT_THAT(errorOf([&] { openBop(folder.path() / "none"); }), HasSubstr("no such folder"));
  EXPECT_THAT(errorOf([&] { openBop(folder.path()); }), HasSubstr("neither models"));
}

TEST(Bop, DamagedFilesAreErrorsThatNameTheEntry) {
  const auto error = [](const std::string& name, const std::string& bytes) {
    const BopFolder folder;
    folder.write(name, bytes);
    return errorOf([&] { openBop(folder.path()); });
  };
  const std::string cameras = "test/000003/scene_camera.json";
  EXPECT_THAT(error(cameras, ""), AllOf(HasSubstr("scene_camera.json"), HasSubstr("empty")));
  EXPECT_THAT(error(cameras, "{\"0\": {"), HasSubstr("not valid JSON"));
  EXPECT_THAT(error(cameras, R"({"0": {"depth_scale": 1}})"),
              AllOf(HasSubstr("image 0"), HasSubstr("cam_K")));
  EXPECT_THAT(error(cameras, R"({"zero": {}})"), HasSubstr("image id is no number"));
  EXPECT_THAT(error("test/000003/scene_bin.json", R"({"0": {}})"),
              AllOf(HasSubstr("scene_bin.json"), HasSubstr("image 0"), HasSubstr("cam_R_bin2c")));
  const std::string infos = "models/models_info.json";
  EXPECT_THAT(error(infos, R"({"1": {}})"), AllOf(HasSubstr("object 1"), HasSubstr("diameter")));
  EXPECT_THAT(error(infos, R"({"1": {"diameter": 1, "symmetries_discrete": [[1, 2]]}})"),
              HasSubstr("symmetries_discrete"));
  EXPECT_THAT(error(infos, R"({"1": {"diameter": 1, "symmetries_discrete":
                  [[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]]}})"),
              HasSubstr("not a rotation"));
  EXPECT_THAT(error(infos,
                    R"({"1": {"diameter": 1, 
                  "symmetries_continuous": [{"axis": [0, 0, 0], "offset": [0, 0, 0]}]}})"),
              HasSubstr("axis"));
  EXPECT_THAT(error("test_targets_bop19.json", R"({"im_id": 1})"), HasSubstr("JSON array"));
  EXPECT_THAT(error("test_targets_bop19.json", R"([{"im_id": 1}])"),
              AllOf(HasSubstr("entry 0"), HasSubstr("scene_id")));
}

TEST(BopCsv, TextIsExact) {
  BopEstimate row;
  row.scene_id = 3;
  row.im_id = 12;
  row.obj_id = 30;
  row.score = 0.875;
  // A quarter turn about z: x goes to y.
  row.camera_from_object.rotation = {{0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  row.camera_from_object.translation_mm = {-1.5, 200.25, 1.0 / 3.0};
  row.time_s = 0.125;
  BopEstimate other;
  other.obj_id = 1;
  other.camera_from_object.translation_mm.x = -0.0;
  const TempFolder folder;
  writeBopCsv(folder.path() / "r.csv", {row, other});
  EXPECT_EQ(bytesOf(folder.path() / "r.csv"),
            "scene_id,im_id,obj_id,score,R,t,time\n"
            "3,12,30,0.875,0 -1 0 1 0 0 0 0 1,-1.5 200.25 0.333333333,0.125\n"
            "0,0,1,0,1 0 0 0 1 0 0 0 1,0 0 0,-1\n");
  EXPECT_EQ(bopCsv({}), "scene_id,im_id,obj_id,score,R,t,time\n");
}

TEST(BopCsv, ValuesThatAreNotFiniteAndDifferentTimesAreErrors) {
  BopEstimate row;
  row.scene_id = 3;
  row.im_id = 12;
  row.obj_id = 30;
  BopEstimate other = row;
  other.time_s = 2.0;
  EXPECT_THAT(errorOf([&] {
                bopCsv({row, other});
              }),
              AllOf(HasSubstr("scene 3 image 12"), HasSubstr("different times")));
  row.camera_from_object.translation_mm.z = std::numeric_limits<double>::quiet_NaN();
  const TempFolder folder;
  EXPECT_THAT(errorOf([&] { writeBopCsv(folder.path() / "r.csv", {row}); }),
              AllOf(HasSubstr("object 30"), HasSubstr("not finite")));
  EXPECT_FALSE(fs::exists(folder.path() / "r.csv"));
}

}  // namespace
}  // namespace rangepose
