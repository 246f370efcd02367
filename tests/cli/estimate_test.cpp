#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/cli_fixture.h"
#include "core/pose.h"
#include "geometry/mesh.h"
#include "io/camera_file.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"
#include "support/backends.h"

namespace rangepose::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class EstimateTest : public CliTest {
 protected:
  json estimateJson(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"--json", "-"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(demoArguments(all));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
};

Pose poseOf(const json& entry) {
  Pose pose;
  for (int i = 0; i < 9; ++i)
    pose.rotation[i % 3][i / 3] = entry.at("cam_R_m2c").at(static_cast<std::size_t>(i));
  for (int i = 0; i < 3; ++i)
    pose.translation_mm[i] = entry.at("cam_t_m2c").at(static_cast<std::size_t>(i));
  return pose;
}

/// Mean distance from points of the mesh in one pose to the nearest vertex in the other (ADD-S), so
/// that symmetric poses count as equal [mm].
double surfaceDistance(const Mesh& mesh, const Pose& estimate, const Pose& truth) {
  const Pose truth_from_estimate = truth.inverse() * estimate;
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 17, ++count) {
    const glm::dvec3 point = truth_from_estimate * glm::dvec3(mesh.vertices[i]);
    double nearest = std::numeric_limits<double>::max();
    for (const glm::vec3& vertex : mesh.vertices) {
      const glm::dvec3 gap = point - glm::dvec3(vertex);
      nearest = std::min(nearest, glm::dot(gap, gap));
    }
    sum += std::sqrt(nearest);
  }
  return sum / count;
}

double nearestTruth(const Pose& estimate) {
  const Mesh mesh = readMesh(kModels / "elbow.ply", LengthUnit::kMillimetre);
  double best = std::numeric_limits<double>::max();
  for (const json& entry : json::parse(readText(kModels / "demo/ground_truth.json"))) {
    best = std::min(best, surfaceDistance(mesh, estimate, poseOf(entry)));
  }
  return best;
}

constexpr double kElbowDiameterMm = 114.28;

/// The demo's depth image as an unorganised cloud (PCD, ascii, metres), as the driver of a sensor
/// writes it.
std::string demoCloud() {
  const DepthImage image =
      readDepth(kModels / "demo/depth.png", readCamera(kModels / "demo/camera.json"));
  std::ostringstream points;
  points.precision(8);
  int count = 0;
  for (int y = 0; y < image.depth_mm.height(); ++y) {
    for (int x = 0; x < image.depth_mm.width(); ++x) {
      const double depth_mm = static_cast<double>(image.depth_mm.at(x, y));
      if (depth_mm <= 0.0) continue;
      const glm::dvec3 point = image.camera.unproject(x, y, depth_mm) / 1000.0;
      points << point.x << ' ' << point.y << ' ' << point.z << '\n';
      ++count;
    }
  }
  const std::string number = std::to_string(count);
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + number +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + number + "\nDATA ascii\n" + points.str();
}

class EstimateCloudTest : public EstimateTest {
 protected:
  RunResult estimateCloud(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"estimate",
                                          "--db",
                                          elbowDatabase(),
                                          "--cloud",
                                          write("demo.pcd", demoCloud()).string(),
                                          "--camera",
                                          (kModels / "demo/camera.json").string(),
                                          "--json",
                                          "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(EstimateTest, FindsAnElbowOfTheDemo) {
  const json answer = estimateJson({});
  ASSERT_EQ(answer.at("poses").size(), 1U);
  EXPECT_LT(nearestTruth(poseOf(answer.at("poses").at(0))), 0.02 * kElbowDiameterMm);
}

TEST_F(EstimateTest, DistanceToTheTruthSeesATurnedPose) {
  const json truth = json::parse(readText(kModels / "demo/ground_truth.json")).at(1);
  Pose turned = poseOf(truth);
  EXPECT_LT(nearestTruth(turned), 1e-3);
  turned.rotation = turned.rotation * rotationFromVector({0.0, 0.3, 0.0});
  EXPECT_GT(nearestTruth(turned), 0.02 * kElbowDiameterMm);
}

TEST_F(EstimateTest, AllFindsSeveralElbowsThoseToPickFirst) {
  const json poses = estimateJson({"--all"}).at("poses");
  ASSERT_GE(poses.size(), 3U);
  const auto step = [](const json& pose) {
    return std::floor(10.0 * pose.at("score").get<double>() * pose.at("freedom").get<double>());
  };
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_GE(step(poses.at(i - 1)), step(poses.at(i))) << "score times freedom in tenths";
    if (step(poses.at(i - 1)) > step(poses.at(i))) continue;
    EXPECT_GE(poses.at(i - 1).at("height_mm"), poses.at(i).at("height_mm"));
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(nearestTruth(poseOf(poses.at(static_cast<std::size_t>(i)))), 0.02 * kElbowDiameterMm)
        << i;
  }
}

TEST_F(EstimateTest, MaxPosesAndMinScoreLimitTheAnswer) {
  EXPECT_EQ(estimateJson({"--max-poses", "2"}).at("poses").size(), 2U);
  EXPECT_EQ(estimateJson({"--first"}).at("poses").size(), 1U);
  EXPECT_EQ(estimateJson({"--min-score", "1"}).at("poses").size(), 0U);
}

TEST_F(EstimateTest, NoPoseIsAnAnswer) {
  const RunResult result = run(demoArguments({"--min-score", "1", "--overlay", "o.png"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("no pose found with a score of at least 1\n"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "o.png"));
}

TEST_F(EstimateTest, TextHasAHeaderALineAPoseAndTimes) {
  const RunResult result = run(demoArguments({}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(
      result.out,
      ContainsRegex("order +object +score +freedom +height.mm. +x.mm. .* qw +qx +qy +qz\n"));
  EXPECT_THAT(result.out, ContainsRegex("\n    1  elbow +[01]\\.[0-9]+( +-?[0-9.]+)+\n"));
  EXPECT_THAT(result.out, ContainsRegex("times .ms.:.* rough search [0-9.]+,.* total [0-9.]+\n"));
  EXPECT_EQ(result.err, "");
}

TEST_F(EstimateTest, GlslPathFindsThePoseOfTheHostPath) {
  const RunResult result = run(demoArguments({"--json", "-", "--path", "glsl", "--starts", "1"}));
  if (result.exit_code == 3 && !backendRequired("gles")) GTEST_SKIP() << result.err;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = json::parse(result.out);
  EXPECT_EQ(answer.at("path"), "glsl");
  ASSERT_EQ(answer.at("poses").size(), 1U);
  EXPECT_LT(nearestTruth(poseOf(answer.at("poses").at(0))), 0.02 * kElbowDiameterMm);
}

TEST_F(EstimateTest, PathsThatAreNotHereAreExitCodeThree) {
  if (!cudaWorks()) {
    EXPECT_TRUE(failsWith(run(demoArguments({"--path", "cuda", "--json", "j"})), 3, {"cuda"}));
  }
  EXPECT_TRUE(
      failsWith(run(demoArguments({"--path", "glsl", "--json", "j"}), kNoEgl), 3, {"OpenGL ES"}));
  EXPECT_FALSE(std::filesystem::exists(folder() / "j"));
}

TEST_F(EstimateTest, AutoWorksWithoutEgl) {
  const RunResult result = run(demoArguments({}), kNoEgl);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("path host"));
}

TEST_F(EstimateCloudTest, CloudOfTheDemoGivesThePoseToo) {
  const RunResult result = estimateCloud({});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = json::parse(result.out);
  ASSERT_EQ(answer.at("poses").size(), 1U);
  EXPECT_LT(nearestTruth(poseOf(answer.at("poses").at(0))), 0.02 * kElbowDiameterMm);
}

TEST_F(EstimateCloudTest, CloudInAWrongUnitIsWarnedOf) {
  const RunResult result = estimateCloud({"--unit", "mm"});
  EXPECT_THAT(result.err, ContainsRegex("rangepose: warning: object elbow .* unit"));
  EXPECT_TRUE(json::accept(result.out));
}

TEST_F(EstimateTest, BinLimitsTheSearch) {
  // A bin far beside the heap: nothing is left to be found.
  write("bin.json",
        R"({"cam_R_bin2c": [1,0,0,0,-1,0,0,0,-1], "cam_t_bin2c": [2000,0,700],
 "inner_size": [100,100,100]})");
  EXPECT_EQ(estimateJson({"--bin", "bin.json"}).at("poses").size(), 0U);
}

}  // namespace
}  // namespace rangepose::test
