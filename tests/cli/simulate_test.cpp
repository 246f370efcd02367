#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/cli_fixture.h"
#include "io/bop.h"
#include "io/bop_truth.h"
#include "io/depth_file.h"
#include "io/json_fields.h"
#include "io/mesh_file.h"
#include "stages/surface.h"

namespace rangepose::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class SimulateTest : public CliTest {
 protected:
  std::string model(const std::string& name) const { return (kModels / (name + ".ply")).string(); }
  /// Few parts in small images: quick.
  RunResult simulate(const std::vector<std::string>& models,
                     const std::string& out,
                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"simulate"};
    arguments.insert(arguments.end(), models.begin(), models.end());
    arguments.insert(arguments.end(), {"-o", out});
    const std::pair<std::string, std::string> defaults[] = {
        {"--bins", "2"}, {"--count", "4"}, {"--size", "160x120"}};
    for (const auto& [option, value] : defaults) {
      if (std::find(more.begin(), more.end(), option) != more.end()) continue;
      arguments.insert(arguments.end(), {option, value});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// All files of a folder with their bytes.
  std::map<std::string, std::string> contents(const std::string& out) const {
    std::map<std::string, std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder() / out)) {
      if (!entry.is_regular_file()) continue;
      result[fs::relative(entry.path(), folder() / out).string()] = readText(entry.path());
    }
    return result;
  }
};

/// Pixels at which the depth image shows the mesh at its true pose, to half a millimetre.
int pixelsShowing(const Mesh& mesh, const Pose& pose, const DepthImage& image) {
  const Sphere sphere = boundingSphere(mesh);
  const SurfaceWindow window =
      windowAround(image.camera, pose * sphere.center_mm, sphere.radius_mm, 10000);
  const Image<SurfaceTexel> surface = host::renderSurface(mesh, image.camera, pose, window);
  int count = 0;
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const float expected = surface.at(x, y).w;
      if (expected == 0.0f) continue;
      const float seen = image.depth_mm.at(window.x0 + x, window.y0 + y);
      EXPECT_LE(seen, expected + 0.5f) << "seen through a part";
      count += std::abs(seen - expected) < 0.5f ? 1 : 0;
    }
  }
  return count;
}

TEST_F(SimulateTest, WritesADataSetThatIsReadBack) {
  const RunResult result = simulate({model("bolt"), model("bracket")}, "set", {"--sensor", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ContainsRegex("1 +bolt +62.58 +[0-9]+ +C6\n"));
  EXPECT_THAT(result.out, ContainsRegex("2 +bracket +92.38 +[0-9]+ +none\n"));
  EXPECT_THAT(result.out, ContainsRegex("set: 2 bins of 4 parts, [0-9.]+ s\n$"));
  EXPECT_EQ(result.err, "");

  const BopDataset set = openBop(folder() / "set");
  ASSERT_THAT(set.models, SizeIs(2));
  ASSERT_TRUE(set.models[0].info.has_value());
  EXPECT_NEAR(set.models[0].info->diameter_mm, 62.58, 0.01);
  EXPECT_THAT(set.models[0].info->symmetries_discrete, SizeIs(5));
  EXPECT_THAT(set.models[1].info->symmetries_discrete, SizeIs(0));
  ASSERT_THAT(set.scenes, SizeIs(2));
  for (const BopScene& scene : set.scenes) {
    ASSERT_THAT(scene.images, SizeIs(1));
    const BopImage& image = scene.images[0];
    ASSERT_TRUE(image.bin.has_value());
    const DepthImage depth = readDepth(image.depth_path, image.camera);
    EXPECT_EQ(depth.camera.width, 160);
    const auto truth = readBopTruth(scene.folder).at(image.im_id);
    EXPECT_THAT(truth, SizeIs(4));
    const auto info =
        readJsonFile(scene.folder / "scene_gt_info.json", "list").at(std::to_string(image.im_id));
    int visible_parts = 0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_EQ(truth[k].obj_id, scene.scene_id);  // one model a bin, in turn
      const BopModel& model = set.models[static_cast<std::size_t>(truth[k].obj_id) - 1];
      const Mesh mesh = readMesh(model.mesh_path, LengthUnit::kMillimetre);
      const int showing = pixelsShowing(mesh, truth[k].camera_from_object, depth);
      const int told = info.at(k).at("px_count_visib");
      EXPECT_NEAR(showing, told, 3 + 0.03 * told);
      EXPECT_NEAR(truth[k].visible_fraction.value(),
                  told / info.at(k).at("px_count_all").get<double>(),
                  1e-9);
      visible_parts += truth[k].visible_fraction.value() >= 0.1 ? 1 : 0;
      // In the bin, and not below its floor.
      const glm::dvec3 center = image.bin->camera_from_bin.inverse() *
                                (truth[k].camera_from_object * boundingSphere(mesh).center_mm);
      EXPECT_LT(std::abs(center.x), 0.5 * image.bin->inner_size_mm.x);
      EXPECT_LT(std::abs(center.y), 0.5 * image.bin->inner_size_mm.y);
      EXPECT_GT(center.z, 0.0);
      EXPECT_LT(center.z, image.bin->inner_size_mm.z);
    }
    ASSERT_THAT(image.targets, SizeIs(1));
    EXPECT_EQ(image.targets[0].obj_id, scene.scene_id);
    EXPECT_EQ(image.targets[0].inst_count, visible_parts);
  }
}

TEST_F(SimulateTest, SameSeedSameFilesWithAnyNumberOfThreads) {
  ASSERT_EQ(simulate({model("bolt")}, "a", {"--threads", "1"}).exit_code, 0);
  ASSERT_EQ(simulate({model("bolt")}, "b").exit_code, 0);
  ASSERT_EQ(simulate({model("bolt")}, "c", {"--seed", "2"}).exit_code, 0);
  EXPECT_THAT(contents("a"), SizeIs(4 + 2 * 5));
  EXPECT_TRUE(contents("a") == contents("b"));
  const std::string depth = "test/000001/depth/000000.png";
  EXPECT_FALSE(contents("a").at(depth) == contents("c").at(depth));
  EXPECT_FALSE(contents("a").at(depth) == contents("a").at("test/000002/depth/000000.png"));
}

TEST_F(SimulateTest, MixedBinsHoldAllModels) {
  ASSERT_EQ(
      simulate({model("bolt"), model("bracket")}, "set", {"--mixed", "--count", "5"}).exit_code, 0);
  for (const char* scene : {"000001", "000002"}) {
    std::map<int, int> counts;
    const auto truth = readBopTruth(folder() / "set/test" / scene);
    for (const BopTruth& part : truth.at(0)) ++counts[part.obj_id];
    EXPECT_EQ(counts[1] + counts[2], 5);
    EXPECT_GE(std::min(counts[1], counts[2]), 2);
  }
}

TEST_F(SimulateTest, OptionsOfTheScannerAndTheBin) {
  const RunResult result = simulate({model("bolt")},
                                    "set",
                                    {"--orthographic",
                                     "--bins",
                                     "1",
                                     "--bin-size",
                                     "200x150x80",
                                     "--camera-distance",
                                     "900",
                                     "--tilt",
                                     "0",
                                     "--sensor",
                                     "rough"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const BopImage image = openBop(folder() / "set").scenes.at(0).images.at(0);
  EXPECT_TRUE(image.camera.orthographic);
  EXPECT_NEAR(image.camera.pixel_size_mm, 900.0 / (570.0 * 160 / 640), 1e-9);
  EXPECT_EQ(image.bin.value().inner_size_mm, glm::dvec3(200, 150, 80));
  EXPECT_NEAR(image.bin->camera_from_bin.translation_mm.z, 900.0 + 40.0, 1e-9);
  const DepthImage depth = readDepth(image.depth_path, image.camera);
  const double lost = 1.0 - validPixels(depth) / (160.0 * 120.0);
  EXPECT_GT(lost, 0.09);
  EXPECT_LT(lost, 0.5);
}

TEST_F(SimulateTest, UnitsScale) {
  const Mesh bolt = readMesh(model("bolt"), LengthUnit::kMillimetre);
  Mesh metres = bolt;
  for (glm::vec3& vertex : metres.vertices) vertex *= 0.001f;
  writePly(folder() / "metres.ply", metres);
  ASSERT_EQ(simulate({"metres.ply"}, "set", {"--unit", "m", "--bins", "1"}).exit_code, 0);
  EXPECT_NEAR(openBop(folder() / "set").models.at(0).info->diameter_mm, 62.58, 0.01);
}

TEST_F(SimulateTest, AnOpenMeshIsWarnedOf) {
  Mesh mesh = readMesh(model("bolt"), LengthUnit::kMillimetre);
  mesh.triangles.resize(mesh.triangles.size() - 40);
  writePly(folder() / "open.ply", mesh);
  const RunResult result = simulate({"open.ply"}, "set", {"--bins", "1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, ContainsRegex("^rangepose: warning: object open is not closed.*\n$"));
  EXPECT_THAT(openBop(folder() / "set").scenes, SizeIs(1));
}

// Users whose sensor is not a structured-light one measure on images of another.
TEST_F(SimulateTest, EverySensorTakesItsOwnImages) {
  const std::pair<const char*, std::pair<int, int>> sensors[] = {
      {"stereo", {1280, 720}}, {"speckle", {640, 480}}, {"tof", {640, 576}}, {"laser", {640, 240}}};
  for (const auto& [sensor, size] : sensors) {
    const RunResult result =
        run({"simulate", model("bolt"), "-o", sensor, "--bins", "1", "--sensor", sensor});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const BopImage image = openBop(folder() / sensor).scenes.at(0).images.at(0);
    const DepthImage depth = readDepth(image.depth_path, image.camera);
    EXPECT_EQ(depth.camera.width, size.first) << sensor;
    EXPECT_EQ(depth.camera.height, size.second) << sensor;
    const auto measured = std::count_if(
        depth.depth_mm.begin(), depth.depth_mm.end(), [](float z) { return z > 0.0f; });
    EXPECT_GT(measured, depth.camera.width * depth.camera.height / 4) << sensor;
  }
}

TEST_F(SimulateTest, EmptyingTakesTheHighestPartsAwayAndMovesNoOther) {
  ASSERT_EQ(simulate({model("bolt")}, "set", {"--bins", "1", "--count", "6", "--emptying", "3"})
                .exit_code,
            0);
  const BopScene scene = openBop(folder() / "set").scenes.at(0);
  ASSERT_THAT(scene.images, SizeIs(3));
  const auto truth = readBopTruth(scene.folder);
  const Mesh mesh = readMesh(model("bolt"), LengthUnit::kMillimetre);
  const Pose bin_from_camera = scene.images[0].bin.value().camera_from_bin.inverse();
  const auto heightsIn = [&](int image) {
    std::vector<double> heights;
    for (const BopTruth& part : truth.at(image)) {
      const glm::dvec3 middle = part.camera_from_object * boundingSphere(mesh).center_mm;
      heights.push_back((bin_from_camera * middle).z);
    }
    std::sort(heights.begin(), heights.end());
    return heights;
  };
  for (int image = 0; image < 3; ++image) {
    ASSERT_THAT(truth.at(image), SizeIs(6 - 2 * image));
    EXPECT_NEAR(
        heightsIn(image).back(), heightsIn(0)[static_cast<std::size_t>(5 - 2 * image)], 1e-6);
    for (const BopTruth& part : truth.at(image)) {
      const bool was_there =
          std::any_of(truth.at(0).begin(), truth.at(0).end(), [&](const BopTruth& before) {
            return before.camera_from_object.translation_mm ==
                   part.camera_from_object.translation_mm;
          });
      EXPECT_TRUE(was_there) << "image " << image;
    }
  }
}

TEST_F(SimulateTest, WornPartsHaveTheModelsPosesButNotTheirImages) {
  ASSERT_EQ(simulate({model("bracket")}, "new", {"--bins", "1"}).exit_code, 0);
  ASSERT_EQ(simulate({model("bracket")}, "worn", {"--bins", "1", "--wear"}).exit_code, 0);
  const auto before = contents("new");
  const auto after = contents("worn");
  EXPECT_EQ(before.at("models/obj_000001.ply"), after.at("models/obj_000001.ply"));
  EXPECT_EQ(before.at("test/000001/scene_gt.json"), after.at("test/000001/scene_gt.json"));
  EXPECT_NE(before.at("test/000001/depth/000000.png"), after.at("test/000001/depth/000000.png"));
}

TEST_F(SimulateTest, HelpShowsExamples) {
  const RunResult result = run({"simulate", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* word : {"Examples:",
                           "--mixed",
                           "--sensor",
                           "--seed",
                           "--bin-size",
                           "--wear",
                           "--emptying",
                           "realsense-d435"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

TEST_F(SimulateTest, WrongUsage) {
  const std::string bolt = model("bolt");
  EXPECT_TRUE(failsWith(run({"simulate", "-o", "set"}), 2, {"models"}));
  EXPECT_TRUE(failsWith(run({"simulate", bolt}), 2, {"--out"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--count", "0"}), 2, {"--count", "range"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--bins", "0"}), 2, {"--bins", "range"}));
  EXPECT_TRUE(
      failsWith(simulate({bolt}, "set", {"--size", "7x100"}), 2, {"--size", "WIDTHxHEIGHT"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--size", "640"}), 2, {"--size"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--bin-size", "10x20"}), 2, {"--bin-size"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--bin-size", "10x20x-3"}), 2, {"--bin-size"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--sensor", "loud"}), 2, {"--sensor", "loud"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--sensor", "tof", "--orthographic"}),
                        2,
                        {"tof", "--orthographic"}));
  EXPECT_TRUE(failsWith(simulate({bolt}, "set", {"--emptying", "0"}), 2, {"--emptying"}));
  EXPECT_THAT(files(), ElementsAre());
}

TEST_F(SimulateTest, BadInputIsNamed) {
  EXPECT_TRUE(failsWith(simulate({"none.ply"}, "set"), 1, {"none.ply"}));
  write("junk.ply", "ply\nnot really");
  EXPECT_TRUE(failsWith(simulate({"junk.ply"}, "set"), 1, {"junk.ply"}));
  EXPECT_FALSE(fs::exists(folder() / "set"));
}

TEST_F(SimulateTest, AFolderThatCannotBeUsedIsNamed) {
  write("full/old.txt", "x");
  EXPECT_TRUE(failsWith(simulate({model("bolt")}, "full"), 1, {"full", "not empty"}));
  EXPECT_TRUE(failsWith(simulate({model("bolt")}, "full/old.txt/set"), 1, {"cannot be made"}));
  EXPECT_THAT(files(), ElementsAre("full/old.txt"));
}

TEST_F(SimulateTest, AFullBinIsAnErrorThatSaysWhatToDo) {
  const RunResult result =
      simulate({model("bolt")}, "set", {"--count", "40", "--bin-size", "100x100x40"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, ContainsRegex("^rangepose: drop: .*larger bin or fewer parts\n$"));
  EXPECT_FALSE(fs::exists(folder() / "set/test/000001/scene_camera.json"));
  EXPECT_FALSE(fs::exists(folder() / "set/test_targets_bop19.json"));
}

TEST_F(SimulateTest, AnInterruptLeavesWholeScenes) {
  // Once there is a scene, however long that takes.
  const auto begun = [&] { return fs::exists(folder() / "set/test/000001/scene_camera.json"); };
  const std::vector<std::string> arguments = {"simulate",
                                              model("bolt"),
                                              "-o",
                                              "set",
                                              "--bins",
                                              "100000",
                                              "--count",
                                              "1",
                                              "--size",
                                              "64x48"};
  const RunResult result = runRangeposeUntil(begun, SIGINT, arguments, folder());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err,
              ContainsRegex("^rangepose: interrupted; [0-9]+ of 100000 bins are in set"));
  const BopDataset set = openBop(folder() / "set");
  EXPECT_GE(set.scenes.size(), 1u);
  for (const BopScene& scene : set.scenes) {
    ASSERT_THAT(scene.images, SizeIs(1));
    EXPECT_GT(validPixels(readDepth(scene.images[0].depth_path, scene.images[0].camera)), 0);
    EXPECT_THAT(readBopTruth(scene.folder).at(0), SizeIs(1));
  }
  for (const std::string& file : files()) EXPECT_THAT(file, Not(HasSubstr(".tmp")));
}

}  // namespace
}  // namespace rangepose::test
