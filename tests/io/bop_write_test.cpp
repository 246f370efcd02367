// What is written is what is read.
#include "io/bop_write.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "io/bop_truth.h"
#include "io/depth_file.h"
#include "io/io_support.h"
#include "io/json_fields.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;
using testing::HasSubstr;

Mesh tetrahedron() {
  Mesh mesh;
  mesh.name = "tetrahedron";
  mesh.vertices = {{0, 0, 0}, {30, 0, 0}, {0, 20, 0}, {-5, 0, 10}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

Pose somePose(double angle) {
  return {rotationFromVector({angle, -0.7, 0.3}), {12.25, -3.5, 700.125 + angle}};
}

BopPart somePart(int obj_id, double visible) {
  BopPart part;
  part.obj_id = obj_id;
  part.camera_from_object = somePose(0.1 * obj_id);
  part.visible_fraction = visible;
  part.all_px = 200;
  part.measured_px = 150;
  part.visible_px = static_cast<int>(200 * visible);
  part.all_box = {-4, 3, 16, 23};
  part.visible_box = {0, 3, 16, 20};
  return part;
}

BopView someView() {
  BopView view;
  view.im_id = 4;
  view.image.camera.width = 8;
  view.image.camera.height = 6;
  view.image.camera.fx = 100.5;
  view.image.camera.fy = 100.25;
  view.image.camera.cx = 3.5;
  view.image.camera.cy = 2.5;
  view.image.camera.depth_scale = 0.125;
  view.image.depth_mm = Image<float>(8, 6, 512.125f);
  view.image.depth_mm.at(2, 1) = 0.0f;
  view.camera_from_world = somePose(0.4);
  view.bin = BinBox{somePose(-0.2), {300.0, 200.0, 100.0}};
  view.parts = {somePart(2, 0.5), somePart(1, 0.05), somePart(2, 1.0)};
  return view;
}

void expectNear(const Pose& a, const Pose& b) {
  EXPECT_LT(rotationAngleBetween(a.rotation, b.rotation), 1e-7);
  EXPECT_LT(glm::distance(a.translation_mm, b.translation_mm), 1e-9);
}

TEST(BopWrite, ASceneIsReadAsItWasWritten) {
  const TempFolder folder;
  const BopView view = someView();
  writeBopScene(folder.path() / "test" / "000003", {view});
  const BopDataset dataset = openBop(folder.path());
  ASSERT_EQ(dataset.scenes.size(), 1u);
  EXPECT_EQ(dataset.scenes[0].scene_id, 3);
  ASSERT_EQ(dataset.scenes[0].images.size(), 1u);
  const BopImage& image = dataset.scenes[0].images[0];
  EXPECT_EQ(image.im_id, 4);
  EXPECT_EQ(image.camera.fx, 100.5);
  EXPECT_EQ(image.camera.fy, 100.25);
  EXPECT_EQ(image.camera.cx, 3.5);
  EXPECT_EQ(image.camera.depth_scale, 0.125);
  ASSERT_TRUE(image.bin.has_value());
  expectNear(image.bin->camera_from_bin, view.bin->camera_from_bin);
  EXPECT_EQ(image.bin->inner_size_mm, view.bin->inner_size_mm);
  EXPECT_EQ(readDepth(image.depth_path, image.camera).depth_mm, view.image.depth_mm);
  const auto truth = readBopTruth(dataset.scenes[0].folder).at(4);
  ASSERT_EQ(truth.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(truth[k].obj_id, view.parts[k].obj_id);
    expectNear(truth[k].camera_from_object, view.parts[k].camera_from_object);
    EXPECT_EQ(truth[k].visible_fraction, view.parts[k].visible_fraction);
  }
}

TEST(BopWrite, VisibilityHasTheFieldsOfBop) {
  const TempFolder folder;
  BopView view = someView();
  view.parts[1].visible_box = {};
  writeBopScene(folder.path() / "scene", {view});
  const auto info = readJsonFile(folder.path() / "scene" / "scene_gt_info.json", "list")["4"];
  EXPECT_EQ(info[0]["bbox_obj"], (std::vector<int>{-4, 3, 20, 20}));
  EXPECT_EQ(info[0]["bbox_visib"], (std::vector<int>{0, 3, 16, 17}));
  EXPECT_EQ(info[1]["bbox_visib"], (std::vector<int>{-1, -1, -1, -1}));
  EXPECT_EQ(info[0]["px_count_all"], 200);
  EXPECT_EQ(info[0]["px_count_valid"], 150);
  EXPECT_EQ(info[0]["px_count_visib"], 100);
}

TEST(BopWrite, AnOrthographicCameraComesBack) {
  const TempFolder folder;
  BopView view = someView();
  view.image.camera.orthographic = true;
  view.image.camera.pixel_size_mm = 0.75;
  writeBopScene(folder.path() / "test" / "000001", {view});
  const BopDataset dataset = openBop(folder.path());
  const Camera& camera = dataset.scenes.at(0).images.at(0).camera;
  EXPECT_TRUE(camera.orthographic);
  EXPECT_EQ(camera.pixel_size_mm, 0.75);
  EXPECT_EQ(camera.cx, 3.5);
  EXPECT_EQ(camera.width, 8);
}

TEST(BopWrite, ASceneWithoutABinHasNoBinFile) {
  const TempFolder folder;
  BopView view = someView();
  view.bin.reset();
  writeBopScene(folder.path() / "test" / "000001", {view});
  EXPECT_FALSE(fs::exists(folder.path() / "test" / "000001" / "scene_bin.json"));
  EXPECT_FALSE(openBop(folder.path()).scenes.at(0).images.at(0).bin.has_value());
}

TEST(BopWrite, AFailureLeavesNoScene) {
  const TempFolder folder;
  BopView far = someView();
  far.im_id = 5;
  far.image.depth_mm.at(0, 0) = 1e6f;  // more than 16 bits hold
  EXPECT_THAT(test::errorOf([&] {
                writeBopScene(folder.path() / "test" / "000001", {someView(), far});
              }),
              HasSubstr("depth_scale"));
  EXPECT_FALSE(fs::exists(folder.path() / "test" / "000001" / "scene_camera.json"));
  EXPECT_FALSE(fs::exists(folder.path() / "test" / "000001" / "depth" / "000005.png"));
}

TEST(BopWrite, ModelsComeBackWithTheirSymmetries) {
  const TempFolder folder;
  BopMesh first{tetrahedron(), {}};
  first.info.diameter_mm = 36.5;
  first.info.symmetries_discrete = {somePose(1.0)};
  BopMesh second{tetrahedron(), {}};
  second.info.diameter_mm = 36.5;
  second.info.symmetries_continuous = {{{0.0, 0.6, 0.8}, {1.0, 2.0, 3.0}}};
  writeBopModels(folder.path() / "models", {first, second});
  const std::vector<BopModel> models = readBopModels(folder.path() / "models");
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].obj_id, 1);
  EXPECT_EQ(models[1].obj_id, 2);
  EXPECT_EQ(readMesh(models[0].mesh_path, LengthUnit::kMillimetre).triangles.size(), 4u);
  ASSERT_TRUE(models[0].info && models[1].info);
  EXPECT_EQ(models[0].info->diameter_mm, 36.5);
  ASSERT_EQ(models[0].info->symmetries_discrete.size(), 1u);
  expectNear(models[0].info->symmetries_discrete[0], somePose(1.0));
  ASSERT_EQ(models[1].info->symmetries_continuous.size(), 1u);
  EXPECT_NEAR(models[1].info->symmetries_continuous[0].axis.z, 0.8, 1e-12);
  EXPECT_EQ(models[1].info->symmetries_continuous[0].offset_mm, glm::dvec3(1.0, 2.0, 3.0));
  const auto infos = readJsonFile(folder.path() / "models" / "models_info.json", "list");
  EXPECT_EQ(infos["1"]["min_x"], -5.0);
  EXPECT_EQ(infos["1"]["size_x"], 35.0);
  EXPECT_EQ(infos["1"]["size_z"], 10.0);
}

TEST(BopWrite, TargetsAreTheVisibleParts) {
  const TempFolder folder;
  const BopView view = someView();
  const std::vector<BopTarget> targets = targetsOf(3, view);
  ASSERT_EQ(targets.size(), 1u);
  EXPECT_EQ(targets[0].obj_id, 2);
  EXPECT_EQ(targets[0].inst_count, 2);
  EXPECT_EQ(targetsOf(3, view, 0.01).size(), 2u);
  writeBopScene(folder.path() / "test" / "000003", {view});
  writeBopTargets(folder.path() / "test_targets_bop19.json", targets);
  const BopDataset dataset = openBop(folder.path());
  ASSERT_EQ(dataset.targets.size(), 1u);
  EXPECT_EQ(dataset.targets[0].scene_id, 3);
  EXPECT_EQ(dataset.targets[0].im_id, 4);
  EXPECT_EQ(dataset.scenes.at(0).images.at(0).targets.size(), 1u);
}

TEST(BopWrite, AFolderThatCannotBeMadeIsNamed) {
  const TempFolder folder;
  folder.write("file", "x");
  EXPECT_THAT(
      test::errorOf([&] { writeBopScene(folder.path() / "file" / "000001", {someView()}); }),
      HasSubstr("cannot be made"));
}

}  // namespace
}  // namespace rangepose
